#include "loops/kinematics.h"

#include <algorithm>
#include <cmath>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

int linkOf(const Mechanism& mechanism, const Closure& closure, const LinkFrame& frame) {
  const int link = mechanism.linkIndex(frame.link);
  if (link < 0) {
    throw SceneError("closures: '" + closure.name + "': the robot has no link '" + frame.link +
                     "'");
  }
  return link;
}

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& rpy) {
  using Turn = Eigen::AngleAxisd;
  return (Turn(rpy.z(), Eigen::Vector3d::UnitZ()) * Turn(rpy.y(), Eigen::Vector3d::UnitY()) *
          Turn(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

// Whether each link hangs, in the end, on each joint.
std::vector<bool> carriersOf(const Mechanism& mechanism, int link) {
  std::vector<bool> carries(mechanism.joints().size(), false);
  while (link > 0) {
    carries[static_cast<std::size_t>(link - 1)] = true;
    link = mechanism.joints()[static_cast<std::size_t>(link - 1)].parent_link;
  }
  return carries;
}

}  // namespace

LoopKinematics::LoopKinematics(const Mechanism& mechanism, const Scene& scene)
    : links_(mechanism.links().size()) {
  for (const Joint& joint : mechanism.joints()) {
    joints_.push_back({joint.parent_link, joint.coordinate, joint.type == JointType::kPrismatic,
                       joint.multiplier, joint.offset, joint.R_PK.cast<double>(),
                       joint.p_PoKo_P.cast<double>(), joint.axis_K.cast<double>()});
  }
  for (const Closure& closure : scene.closures) addClosure(mechanism, closure);
  first_.push_back(conditions());
  phi_.setZero(conditions());
  rates_ = accelerations_ = phi_;
  A_.setZero(conditions(), static_cast<Eigen::Index>(mechanism.coordinates().size()));
}

void LoopKinematics::addClosure(const Mechanism& mechanism, const Closure& closure) {
  Frames frames;
  const auto place = [&](const LinkFrame& from, Frame& frame) {
    frame.link = linkOf(mechanism, closure, from);
    frame.R_LF = rotationOf(from.rpy);
    frame.p_LoFo_L = from.xyz;
  };
  place(closure.parent, frames.parent);
  place(closure.child, frames.child);
  if (frames.parent.link == frames.child.link) {
    throw SceneError("closures: '" + closure.name + "': both frames are on link '" +
                     closure.parent.link + "'");
  }
  const std::vector<bool> above_parent = carriersOf(mechanism, frames.parent.link);
  const std::vector<bool> above_child = carriersOf(mechanism, frames.child.link);
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    if (above_parent[k] == above_child[k]) continue;
    frames.path.push_back({static_cast<int>(k), above_child[k] ? 1.0 : -1.0});
  }
  if (std::none_of(frames.path.begin(), frames.path.end(), [&](const Step& step) {
        return joints_[static_cast<std::size_t>(step.joint)].coordinate >= 0;
      })) {
    throw SceneError("closures: '" + closure.name + "': no joint moves '" + closure.child.link +
                     "' relative to '" + closure.parent.link + "'");
  }
  frames.type = closure.type;
  frames.length = closure.length.value_or(0);
  frames.adopts_length = closure.type == ClosureType::kDistance && !closure.length;
  frames_.push_back(frames);
  first_.push_back(conditions());
  addRows(frames_.size() - 1, closure.type);
}

// Axis i of the parent frame along which the origins may not part; axes a of the parent and b of
// the child that stay normal to each other.
void LoopKinematics::addRows(std::size_t closure, ClosureType type) {
  const auto along = [&](int i) { rows_.push_back({Kind::kAlong, closure, i, 0}); };
  const auto normal = [&](int a, int b) { rows_.push_back({Kind::kNormal, closure, a, b}); };
  using Type = ClosureType;
  if (type == Type::kDistance) {
    rows_.push_back({Kind::kDistance, closure, 0, 0});
    return;
  }
  if (type != Type::kPlanar) {
    along(0);
    along(1);
  }
  if (type != Type::kPrismatic && type != Type::kCylindrical) along(2);
  if (type == Type::kUniversal) normal(2, 0);
  if (type == Type::kUniversal || type == Type::kSpherical) return;
  normal(0, 2);
  normal(1, 2);
  if (type == Type::kFixed || type == Type::kPrismatic) normal(0, 1);
}

bool LoopKinematics::turns(Eigen::Index condition) const {
  return rows_[static_cast<std::size_t>(condition)].kind == Kind::kNormal;
}

LoopKinematics::Norms LoopKinematics::normsOf(std::size_t closure,
                                              const Eigen::VectorXd& conditions) const {
  double lengths = 0, directions = 0;
  for (Eigen::Index i = firstOf(closure); i < firstOf(closure + 1); ++i) {
    (turns(i) ? directions : lengths) += conditions[i] * conditions[i];
  }
  return {std::sqrt(lengths), std::sqrt(directions)};
}

Eigen::Vector3d LoopKinematics::axis(const Frame& frame, int i) const {
  return axesOf(frame.link) * frame.R_LF.col(i);
}

Eigen::Vector3d LoopKinematics::parentOrigin(std::size_t closure) const {
  const Frame& frame = frames_[closure].parent;
  return originOf(frame.link) + axesOf(frame.link) * frame.p_LoFo_L;
}

Eigen::Vector3d LoopKinematics::childOrigin(std::size_t closure) const {
  const Frame& frame = frames_[closure].child;
  return originOf(frame.link) + axesOf(frame.link) * frame.p_LoFo_L;
}

Eigen::Matrix3d LoopKinematics::childAxes(std::size_t closure) const {
  const Frame& frame = frames_[closure].child;
  return axesOf(frame.link) * frame.R_LF;
}

Twist LoopKinematics::childTwist(std::size_t closure) const {
  const PointState C = pointOf(frames_[closure].child);
  return {C.v, C.w};
}

bool LoopKinematics::reversed(std::size_t closure) const {
  const Frames& frames = frames_[closure];
  if (frames.type != ClosureType::kFixed && frames.type != ClosureType::kPrismatic) return false;
  return axis(frames.parent, 0).dot(axis(frames.child, 0)) < 0 ||
         axis(frames.parent, 2).dot(axis(frames.child, 2)) < 0;
}

void LoopKinematics::setPosition(const Eigen::VectorXd& q) {
  if (q_.size() == q.size() && q_ == q) return;
  q_ = q;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const JointConstants& joint = joints_[k];
    const LinkState& parent = links_[static_cast<std::size_t>(joint.parent_link)];
    LinkState& link = links_[k + 1];
    const double position =
        joint.coordinate < 0 ? 0 : joint.multiplier * q[joint.coordinate] + joint.offset;
    link.R.noalias() = parent.R * joint.R_PK;
    link.z.noalias() = link.R * joint.axis_K;
    link.o = parent.o + parent.R * joint.p_PoKo_P;
    if (joint.slides) {
      link.o += position * link.z;
    } else if (joint.coordinate >= 0) {
      link.R = (link.R * Eigen::AngleAxisd(position, joint.axis_K).toRotationMatrix()).eval();
    }
  }
  for (Eigen::Index i = 0; i < conditions(); ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    const Frames& frames = frames_[row.closure];
    const Eigen::Vector3d r = childOrigin(row.closure) - parentOrigin(row.closure);
    if (row.kind == Kind::kDistance) {
      phi_[i] = r.norm() - frames.length;
    } else {
      const Eigen::Vector3d a = axis(frames.parent, row.a);
      phi_[i] = row.kind == Kind::kAlong ? a.dot(r) : a.dot(axis(frames.child, row.b));
    }
    // Entries of other coordinates stay zero.
    for (const Step& step : frames.path) {
      const int coordinate = joints_[static_cast<std::size_t>(step.joint)].coordinate;
      if (coordinate >= 0) A_(i, coordinate) = 0;
    }
    if (frames.adopts_length && !adopted_) {
      phi_[i] = 0;
    } else {
      addGeneralizedForce(row.closure, unitWrench(i), A_.row(i));
    }
  }
}

void LoopKinematics::adoptLengths() {
  adopted_ = true;
  q_.resize(0);  // conditions are no longer those of the position
  for (std::size_t c = 0; c < frames_.size(); ++c) {
    if (!frames_[c].adopts_length) continue;
    frames_[c].length = (childOrigin(c) - parentOrigin(c)).norm();
  }
}

ClosureWrench LoopKinematics::unitWrench(Eigen::Index condition) const {
  const Row& row = rows_[static_cast<std::size_t>(condition)];
  const Frames& frames = frames_[row.closure];
  ClosureWrench wrench;
  if (row.kind == Kind::kAlong) {
    wrench.force = axis(frames.parent, row.a);
  } else if (row.kind == Kind::kNormal) {
    wrench.moment = axis(frames.child, row.b).cross(axis(frames.parent, row.a));
  } else {
    wrench.force = (childOrigin(row.closure) - parentOrigin(row.closure)).normalized();
  }
  return wrench;
}

ClosureWrench LoopKinematics::unitEffort(std::size_t closure) const {
  const Frames& frames = frames_[closure];
  ClosureWrench wrench;
  (frames.type == ClosureType::kPrismatic ? wrench.force : wrench.moment) = freeAxis(closure);
  return wrench;
}

double LoopKinematics::freePosition(std::size_t closure) const {
  const Frames& frames = frames_[closure];
  if (frames.type == ClosureType::kPrismatic) {
    return freeAxis(closure).dot(childOrigin(closure) - parentOrigin(closure));
  }
  const Eigen::Vector3d x = axis(frames.child, 0);
  return std::atan2(axis(frames.parent, 1).dot(x), axis(frames.parent, 0).dot(x));
}

double LoopKinematics::freeVelocity(std::size_t closure) const {
  const Frames& frames = frames_[closure];
  const PointState P = pointOf(frames.parent);
  const PointState C = pointOf(frames.child);
  if (frames.type != ClosureType::kPrismatic) return freeAxis(closure).dot(C.w - P.w);
  return freeAxis(closure).dot(C.v - P.v - P.w.cross(C.o - P.o));
}

double LoopKinematics::workOf(const Step& step, const Eigen::Vector3d& at,
                              const ClosureWrench& wrench) const {
  const JointConstants& joint = joints_[static_cast<std::size_t>(step.joint)];
  const LinkState& link = links_[static_cast<std::size_t>(step.joint) + 1];
  const double along = joint.slides ? link.z.dot(wrench.force)
                                    : link.z.dot(wrench.moment + (at - link.o).cross(wrench.force));
  return step.sign * joint.multiplier * along;
}

void LoopKinematics::moveLink(std::size_t k, const Motion& motion) {
  const JointConstants& joint = joints_[k];
  const LinkState& parent = links_[static_cast<std::size_t>(joint.parent_link)];
  LinkState& link = links_[k + 1];
  const Eigen::Vector3d r = link.o - parent.o;
  link.w = parent.w;
  link.alpha = parent.alpha;
  link.v = parent.v + parent.w.cross(r);
  link.a = parent.a + parent.alpha.cross(r) + parent.w.cross(parent.w.cross(r));
  if (joint.coordinate < 0) return;
  const Eigen::Vector3d rate = joint.multiplier * motion.qd[joint.coordinate] * link.z;
  const Eigen::Vector3d acceleration = joint.multiplier * motion.qdd[joint.coordinate] * link.z;
  if (joint.slides) {
    link.v += rate;
    link.a += acceleration + 2 * parent.w.cross(rate);
  } else {
    link.w += rate;
    link.alpha += acceleration + parent.w.cross(rate);
  }
}

LoopKinematics::PointState LoopKinematics::pointOf(const Frame& frame) const {
  const LinkState& link = links_[static_cast<std::size_t>(frame.link)];
  const Eigen::Vector3d r = link.R * frame.p_LoFo_L;
  return {link.o + r, link.v + link.w.cross(r), link.w,
          link.a + link.alpha.cross(r) + link.w.cross(link.w.cross(r)), link.alpha};
}

void LoopKinematics::setMotion(const Motion& motion) {
  for (std::size_t k = 0; k < joints_.size(); ++k) moveLink(k, motion);
  for (std::size_t c = 0; c < frames_.size(); ++c) {
    const PointState P = pointOf(frames_[c].parent), C = pointOf(frames_[c].child);
    for (Eigen::Index i = firstOf(c); i < firstOf(c + 1); ++i) setRates(i, P, C);
  }
}

void LoopKinematics::setRates(Eigen::Index i, const PointState& P, const PointState& C) {
  const Row& row = rows_[static_cast<std::size_t>(i)];
  const Eigen::Vector3d r = C.o - P.o, v = C.v - P.v, acceleration = C.a - P.a;
  const Eigen::Vector3d a = axis(frames_[row.closure].parent, row.a);
  const Eigen::Vector3d ad = P.w.cross(a), add = P.alpha.cross(a) + P.w.cross(ad);
  if (row.kind == Kind::kAlong) {
    rates_[i] = ad.dot(r) + a.dot(v);
    accelerations_[i] = add.dot(r) + 2 * ad.dot(v) + a.dot(acceleration);
  } else if (row.kind == Kind::kNormal) {
    const Eigen::Vector3d b = axis(frames_[row.closure].child, row.b);
    const Eigen::Vector3d bd = C.w.cross(b), bdd = C.alpha.cross(b) + C.w.cross(bd);
    rates_[i] = ad.dot(b) + a.dot(bd);
    accelerations_[i] = add.dot(b) + 2 * ad.dot(bd) + a.dot(bdd);
  } else {
    const double distance = r.norm();
    rates_[i] = distance > 0 ? r.dot(v) / distance : 0;
    accelerations_[i] =
        distance > 0 ? (v.dot(v) + r.dot(acceleration) - rates_[i] * rates_[i]) / distance : 0;
  }
}

}  // namespace virtual_work_dynamics
