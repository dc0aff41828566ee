#include "contenders/dense_linkage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "contenders/peer_input.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kMostSteps = 20;  // of Newton's method
constexpr double kClosed = 1e-12;
constexpr double kExact = std::numeric_limits<double>::epsilon();  // what rounding leaves

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& rpy) {
  using Turn = Eigen::AngleAxisd;
  return (Turn(rpy.z(), Eigen::Vector3d::UnitZ()) * Turn(rpy.y(), Eigen::Vector3d::UnitY()) *
          Turn(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

bool DenseLinkage::canCompute(const BenchmarkScene& scene) {
  const Scene& loops = *scene.loops;
  const auto& joints = scene.mechanism.joints();
  return loops.joints.empty() && loops.actuated && scene.mechanism.orientations() == 0 &&
         std::none_of(joints.begin(), joints.end(),
                      [](const Joint& joint) { return joint.mimics; }) &&
         std::all_of(loops.closures.begin(), loops.closures.end(),
                     [](const Closure& closure) {
                       return closure.type == ClosureType::kRevolute ||
                              closure.type == ClosureType::kSpherical;
                     }) &&
         std::all_of(loops.springs.begin(), loops.springs.end(),
                     [](const PointSpring& spring) { return spring.damping == 0; });
}

DenseLinkage::DenseLinkage(const BenchmarkScene& scene) : gravity_(scene.loops->gravity) {
  const Mechanism mechanism = withoutFixedJoints(scene.mechanism);
  bodies_.resize(mechanism.links().size());
  bodies_[0].R.setIdentity();
  for (Eigen::Vector3d* at_rest :
       {&bodies_[0].o, &bodies_[0].w, &bodies_[0].v, &bodies_[0].alpha}) {
    at_rest->setZero();
  }
  for (const Joint& joint : mechanism.joints()) {
    const Link& link = mechanism.link(joint.child_link);
    Body& body = bodies_[static_cast<std::size_t>(joint.child_link)];
    body.parent = joint.parent_link;
    body.slides = joint.type == JointType::kPrismatic;
    body.R_PK = joint.R_PK.cast<double>();
    body.p_PoKo_P = joint.p_PoKo_P.cast<double>();
    body.axis_K = joint.axis_K.cast<double>();
    body.mass = static_cast<double>(link.mass);
    body.p_KoCm_K = link.p_KoCm_K.cast<double>();
    body.inertia_Cm_K = link.inertia_Cm_K.cast<double>();
  }
  int rows = 0;
  for (const Closure& closure : scene.loops->closures) {
    const bool is_pin = closure.type == ClosureType::kRevolute;
    loops_.push_back(
        {pointOn(scene.mechanism, closure.parent.link, closure.parent.xyz, closure.parent.rpy),
         pointOn(scene.mechanism, closure.child.link, closure.child.xyz, closure.child.rpy), is_pin,
         rows});
    rows += is_pin ? 5 : 3;
  }
  for (const PointSpring& spring : scene.loops->springs) {
    springs_.push_back(
        {pointOn(scene.mechanism, spring.link_a, spring.at_a, Eigen::Vector3d::Zero()),
         pointOn(scene.mechanism, spring.link_b, spring.at_b, Eigen::Vector3d::Zero()),
         spring.stiffness, spring.rest_length});
  }
  const std::vector<std::string>& actuated = *scene.loops->actuated;
  for (std::size_t i = 0; i < mechanism.coordinateNames().size(); ++i) {
    if (std::count(actuated.begin(), actuated.end(), mechanism.coordinateNames()[i]) == 0) {
      passive_.push_back(static_cast<int>(i));
    }
  }
  const auto found = static_cast<Eigen::Index>(passive_.size());
  jacobian_.resize(rows, static_cast<Eigen::Index>(mechanism.joints().size()));
  of_passive_.resize(rows, found);
  misfit_.resize(rows);
  multipliers_.resize(rows);
  found_.resize(found);
  passive_efforts_.resize(found);
  square_ = rows == found;
}

// Links that are welded to others are part of those.
DenseLinkage::Point DenseLinkage::pointOn(const Mechanism& mechanism, const std::string& link,
                                          const Eigen::Vector3d& at, const Eigen::Vector3d& rpy) {
  Point point{mechanism.linkIndex(link), at, rotationOf(rpy)};
  while (point.body > 0 && mechanism.joint(point.body - 1).type == JointType::kFixed) {
    const Joint& weld = mechanism.joint(point.body - 1);
    const Eigen::Matrix3d R = weld.R_PK.cast<double>();
    point.p_KoPo_K = weld.p_PoKo_P.cast<double>() + R * point.p_KoPo_K;
    point.R_KF = R * point.R_KF;
    point.body = weld.parent_link;
  }
  int welds = 0;  // before it
  for (int i = 1; i < point.body; ++i) {
    if (mechanism.joint(i - 1).type == JointType::kFixed) ++welds;
  }
  point.body -= welds;
  return point;
}

Eigen::Vector3d DenseLinkage::placeOf(const Point& point) const {
  const Body& body = bodies_[static_cast<std::size_t>(point.body)];
  return body.o + body.R * point.p_KoPo_K;
}

Eigen::Vector3d DenseLinkage::velocityOf(const Point& point) const {
  const Body& body = bodies_[static_cast<std::size_t>(point.body)];
  return body.v + body.w.cross(body.R * point.p_KoPo_K);
}

Eigen::Vector3d DenseLinkage::accelerationOf(const Point& point) const {
  const Body& body = bodies_[static_cast<std::size_t>(point.body)];
  const Eigen::Vector3d r = body.R * point.p_KoPo_K;
  return body.a + body.alpha.cross(r) + body.w.cross(body.w.cross(r));
}

void DenseLinkage::setPosition(const Eigen::VectorXd& q) {
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const Body& parent = bodies_[static_cast<std::size_t>(body.parent)];
    const double position = q[static_cast<Eigen::Index>(i) - 1];
    body.R.noalias() = parent.R * body.R_PK;
    body.o = parent.o + parent.R * body.p_PoKo_P;
    body.axis = body.R * body.axis_K;
    if (body.slides) {
      body.o += position * body.axis;
    } else {
      body.R = (body.R * Eigen::AngleAxisd(position, body.axis_K).toRotationMatrix()).eval();
    }
  }
}

void DenseLinkage::setVelocity(const Eigen::VectorXd& qd) {
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const Body& parent = bodies_[static_cast<std::size_t>(body.parent)];
    const double rate = qd[static_cast<Eigen::Index>(i) - 1];
    body.w = parent.w;
    body.v = parent.v + parent.w.cross(body.o - parent.o);
    (body.slides ? body.v : body.w) += rate * body.axis;
  }
}

void DenseLinkage::setAcceleration(const Eigen::VectorXd& qdd, const Eigen::Vector3d& of_root) {
  bodies_[0].a = of_root;
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const Body& parent = bodies_[static_cast<std::size_t>(body.parent)];
    const double second = qdd[static_cast<Eigen::Index>(i) - 1];
    const Eigen::Vector3d r = body.o - parent.o;
    body.alpha = parent.alpha;
    body.a = parent.a + parent.alpha.cross(r) + parent.w.cross(parent.w.cross(r));
    if (body.slides) {
      const Eigen::Vector3d sliding = body.v - parent.v - parent.w.cross(r);
      body.a += second * body.axis + 2 * parent.w.cross(sliding);
    } else {
      body.alpha += second * body.axis + parent.w.cross(body.w);
    }
  }
}

// The rows of a point's velocity, and of the components of the angular velocity along `turns` if
// there are any, by the joints that carry it.
void DenseLinkage::addColumns(const Point& point, double sign, int first_row,
                              const Eigen::Vector3d* turns) {
  const Eigen::Vector3d p = placeOf(point);
  for (int i = point.body; i > 0; i = bodies_[static_cast<std::size_t>(i)].parent) {
    const Body& body = bodies_[static_cast<std::size_t>(i)];
    auto column = jacobian_.col(i - 1);
    if (body.slides) {
      column.segment<3>(first_row) += sign * body.axis;
      continue;
    }
    column.segment<3>(first_row) += sign * body.axis.cross(p - body.o);
    if (turns == nullptr) continue;
    column[first_row + 3] += sign * turns[0].dot(body.axis);
    column[first_row + 4] += sign * turns[1].dot(body.axis);
  }
}

void DenseLinkage::setJacobian() {
  jacobian_.setZero();
  for (const Loop& loop : loops_) {
    Eigen::Vector3d turns[2];
    if (loop.is_pin) {
      const Body& parent = bodies_[static_cast<std::size_t>(loop.parent.body)];
      const Body& child = bodies_[static_cast<std::size_t>(loop.child.body)];
      const Eigen::Vector3d z = child.R * loop.child.R_KF.col(2);
      for (int i = 0; i < 2; ++i) turns[i] = z.cross(parent.R * loop.parent.R_KF.col(i));
    }
    addColumns(loop.parent, -1, loop.first_row, loop.is_pin ? turns : nullptr);
    addColumns(loop.child, 1, loop.first_row, loop.is_pin ? turns : nullptr);
  }
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    of_passive_.col(static_cast<Eigen::Index>(i)) = jacobian_.col(passive_[i]);
  }
}

void DenseLinkage::factorize() {
  setJacobian();
  if (square_) {
    lu_.compute(of_passive_);
  } else {
    qr_.compute(of_passive_);
  }
}

void DenseLinkage::solve() {
  if (square_) {
    found_ = lu_.solve(-misfit_);
  } else {
    found_ = qr_.solve(-misfit_);
  }
}

void DenseLinkage::setMisfit() {
  for (const Loop& loop : loops_) {
    misfit_.segment<3>(loop.first_row) = placeOf(loop.child) - placeOf(loop.parent);
    if (!loop.is_pin) continue;
    const Body& parent = bodies_[static_cast<std::size_t>(loop.parent.body)];
    const Body& child = bodies_[static_cast<std::size_t>(loop.child.body)];
    const Eigen::Vector3d z = child.R * loop.child.R_KF.col(2);
    for (int i = 0; i < 2; ++i) {
      misfit_[loop.first_row + 3 + i] = z.dot(parent.R * loop.parent.R_KF.col(i));
    }
  }
}

void DenseLinkage::setVelocityMisfit() {
  for (const Loop& loop : loops_) {
    misfit_.segment<3>(loop.first_row) = velocityOf(loop.child) - velocityOf(loop.parent);
    if (!loop.is_pin) continue;
    const Body& parent = bodies_[static_cast<std::size_t>(loop.parent.body)];
    const Body& child = bodies_[static_cast<std::size_t>(loop.child.body)];
    const Eigen::Vector3d z = child.R * loop.child.R_KF.col(2);
    const Eigen::Vector3d turning = child.w - parent.w;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d x = parent.R * loop.parent.R_KF.col(i);
      misfit_[loop.first_row + 3 + i] = turning.dot(z.cross(x));
    }
  }
}

void DenseLinkage::setAccelerationMisfit() {
  for (const Loop& loop : loops_) {
    misfit_.segment<3>(loop.first_row) = accelerationOf(loop.child) - accelerationOf(loop.parent);
    if (!loop.is_pin) continue;
    const Body& parent = bodies_[static_cast<std::size_t>(loop.parent.body)];
    const Body& child = bodies_[static_cast<std::size_t>(loop.child.body)];
    const Eigen::Vector3d z = child.R * loop.child.R_KF.col(2);
    const Eigen::Vector3d zd = child.w.cross(z);
    const Eigen::Vector3d zdd = child.alpha.cross(z) + child.w.cross(zd);
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d x = parent.R * loop.parent.R_KF.col(i);
      const Eigen::Vector3d xd = parent.w.cross(x);
      misfit_[loop.first_row + 3 + i] =
          zdd.dot(x) + 2 * zd.dot(xd) + z.dot(parent.alpha.cross(x) + parent.w.cross(xd));
    }
  }
}

bool DenseLinkage::complete(Motion& motion) {
  setPosition(motion.q);
  setMisfit();
  double now = misfit_.norm();
  const double exact = kExact * std::sqrt(static_cast<double>(misfit_.size()));
  for (int step = 0; step < kMostSteps && now > exact; ++step) {
    factorize();
    solve();
    for (std::size_t i = 0; i < passive_.size(); ++i) {
      motion.q[passive_[i]] += found_[static_cast<Eigen::Index>(i)];
    }
    setPosition(motion.q);
    setMisfit();
    const double before = now;
    now = misfit_.norm();
    if (now >= before) break;  // rounding errors
  }
  if (!(now <= kClosed)) return false;
  factorize();
  for (const int i : passive_) motion.qd[i] = motion.qdd[i] = 0;
  setVelocity(motion.qd);
  setVelocityMisfit();
  solve();
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    motion.qd[passive_[i]] = found_[static_cast<Eigen::Index>(i)];
  }
  setVelocity(motion.qd);
  setAcceleration(motion.qdd, Eigen::Vector3d::Zero());
  setAccelerationMisfit();
  solve();
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    motion.qdd[passive_[i]] = found_[static_cast<Eigen::Index>(i)];
  }
  return true;
}

// Takes a force that acts on a body from the wrench that its joint must exert.
void DenseLinkage::addForce(const Point& point, const Eigen::Vector3d& force) {
  Body& body = bodies_[static_cast<std::size_t>(point.body)];
  body.force -= force;
  body.moment -= (body.R * point.p_KoPo_K).cross(force);
}

// The efforts of the tree are those of the actuators and A^T times the multipliers, of which
// passive coordinates have the latter alone. Where they are not unique, the least are taken.
void DenseLinkage::computeEfforts(const Motion& motion, Eigen::VectorXd& efforts) {
  setPosition(motion.q);
  setVelocity(motion.qd);
  setAcceleration(motion.qdd, -gravity_);
  for (Body& body : bodies_) {
    if (&body == &bodies_[0]) continue;
    const Eigen::Vector3d c = body.R * body.p_KoCm_K;
    const Eigen::Vector3d w_K = body.R.transpose() * body.w;
    const Eigen::Vector3d about_centre =
        body.R * (body.inertia_Cm_K * (body.R.transpose() * body.alpha) +
                  w_K.cross(body.inertia_Cm_K * w_K));
    body.force = body.mass * (body.a + body.alpha.cross(c) + body.w.cross(body.w.cross(c)));
    body.moment = about_centre + c.cross(body.force);
  }
  bodies_[0].force.setZero();
  bodies_[0].moment.setZero();
  for (const Spring& spring : springs_) {
    const Eigen::Vector3d r = placeOf(spring.b) - placeOf(spring.a);
    const double length = r.norm();
    const Eigen::Vector3d pull = spring.stiffness * (length - spring.rest_length) / length * r;
    addForce(spring.a, pull);
    addForce(spring.b, -pull);
  }
  for (std::size_t i = bodies_.size() - 1; i > 0; --i) {
    const Body& body = bodies_[i];
    efforts[static_cast<Eigen::Index>(i) - 1] =
        body.axis.dot(body.slides ? body.force : body.moment);
    Body& parent = bodies_[static_cast<std::size_t>(body.parent)];
    parent.force += body.force;
    parent.moment += body.moment + (body.o - parent.o).cross(body.force);
  }
  factorize();
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    passive_efforts_[static_cast<Eigen::Index>(i)] = efforts[passive_[i]];
  }
  if (square_) {
    multipliers_ = lu_.transpose().solve(passive_efforts_);
  } else {
    const Eigen::Index n = passive_efforts_.size();
    multipliers_.setZero();
    multipliers_.head(n) = qr_.colsPermutation().transpose() * passive_efforts_;
    qr_.matrixR().topLeftCorner(n, n).triangularView<Eigen::Upper>().transpose().solveInPlace(
        multipliers_.head(n));
    multipliers_.applyOnTheLeft(qr_.householderQ());
  }
  efforts.noalias() -= jacobian_.transpose() * multipliers_;
  for (const int i : passive_) efforts[i] = 0;
}

}  // namespace virtual_work_dynamics
