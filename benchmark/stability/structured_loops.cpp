#include "stability/structured_loops.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace virtual_work_dynamics {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.81;
constexpr int kTypes = 8;
constexpr int kTries = 50;  // for two links between which something moves
const std::array<const char*, 5> kKinds = {"any axes", "parallel axes", "axes through one point",
                                           "axes in one line", "axes along the root's"};

// The coordinates that move a link.
std::set<int> moversOf(const Mechanism& mechanism, int link) {
  std::set<int> movers;
  while (link > 0) {
    const Joint& joint = mechanism.joint(mechanism.link(link).parent_joint);
    if (joint.coordinate >= 0) movers.insert(mechanism.link(link).parent_joint);
    link = joint.parent_link;
  }
  return movers;
}

}  // namespace

Matrix3l StructuredLoops::turn(int axis, long double angle) {
  return Eigen::AngleAxis<long double>(angle, Vector3l::Unit(axis)).toRotationMatrix();
}

Matrix3l StructuredLoops::rotationOf(const Eigen::Vector3d& rpy) {
  return turn(2, rpy.z()) * turn(1, rpy.y()) * turn(0, rpy.x());
}

// Roll is found after yaw is turned back, as near a pitch of a right angle each alone is uncertain.
Eigen::Vector3d StructuredLoops::rpyOf(const Matrix3l& R) {
  const long double yaw = std::atan2(R(1, 0), R(0, 0));
  const Matrix3l back = turn(2, -yaw) * R;
  return Vector3l(std::atan2(-back(1, 2), back(1, 1)), std::atan2(-R(2, 0), back(0, 0)), yaw)
      .cast<double>();
}

std::optional<std::pair<int, int>> StructuredLoops::linksThatMove(const Mechanism& mechanism) {
  const int links = static_cast<int>(mechanism.links().size());
  int parent = 0, child = 0;
  for (int i = 0; i < kTries && moversOf(mechanism, parent) == moversOf(mechanism, child); ++i) {
    parent = pick(links);
    child = pick(links);
  }
  if (moversOf(mechanism, parent) == moversOf(mechanism, child)) return std::nullopt;
  return std::make_pair(parent, child);
}

int StructuredLoops::pick(int count) {
  return std::min(count - 1, static_cast<int>(random_.uniform(0, count)));
}

Vector3l StructuredLoops::vector(double size) {
  const double x = random_.uniform(-size, size), y = random_.uniform(-size, size);
  return {x, y, random_.uniform(-size, size)};
}

Matrix3l StructuredLoops::rotation() {
  const double yaw = random_.uniform(-3, 3), pitch = random_.uniform(-1.4, 1.4);
  return turn(2, yaw) * turn(1, pitch) * turn(0, random_.uniform(-3, 3));
}

Matrix3l StructuredLoops::rightAngles() {
  Matrix3l R = Matrix3l::Identity();
  for (int i = pick(3); i > 0; --i) {
    const int a = pick(3), b = (a + 1) % 3;
    Matrix3l quarter = Matrix3l::Identity();
    quarter(a, a) = quarter(b, b) = 0;
    quarter(a, b) = -1;
    quarter(b, a) = 1;
    R = R * quarter;
  }
  return R;
}

Vector3l StructuredLoops::direction() {
  Vector3l v = vector(1);
  while (v.norm() < 0.1L) v = vector(1);
  return v.normalized().cast<double>().cast<long double>().normalized();
}

Vector3l StructuredLoops::alongAxis() {
  return (random_.chance(0.5) ? 1 : -1) * Vector3l::Unit(pick(3));
}

void StructuredLoops::chooseStyle() {
  axes_ = static_cast<Axes>(pick(static_cast<int>(kKinds.size())));
  const bool extreme = random_.chance(0.5);
  size_ = extreme ? std::pow(10, random_.uniform(-6, 6)) : 1;
  mass_ = extreme ? std::pow(10, random_.uniform(-12, 12)) : 1;
  spread_of_masses_ = random_.chance(0.3) ? random_.uniform(0, 12) : 0;
  spread_of_sizes_ = random_.chance(0.2) ? random_.uniform(0, 1) : 0;
  special_positions_ = random_.chance(0.5);
  beside_ = random_.chance(0.5) ? std::pow(10, random_.uniform(-14, -1)) : 0;
}

std::string StructuredLoops::wayOfAxes() const {
  return kKinds[static_cast<std::size_t>(axes_)];
}

Link StructuredLoops::link(int index) {
  Link link;
  link.name = "link_" + std::to_string(index);
  if (random_.chance(0.15)) return link;  // massless
  double mass = mass_ * random_.uniform(0.1, 5);
  mass *= std::pow(10, random_.uniform(-spread_of_masses_, spread_of_masses_));
  link.mass = std::clamp(mass, 1e-12, 1e12);
  link.p_KoCm_K = vector(0.3 * size_);
  if (random_.chance(0.15)) return link;  // a point
  Vector3l squares =
      size_ * size_ *
      Vector3l(random_.uniform(0, 0.1), random_.uniform(0, 0.1), random_.uniform(0, 0.1));
  const Matrix3l R = rotation();
  const Matrix3l G = link.mass / 12 * R * squares.asDiagonal() * R.transpose();
  const Matrix3l inertia = G.trace() * Matrix3l::Identity() - (G + G.transpose()) / 2;
  link.inertia_Cm_K = inertia.cast<double>().cast<long double>();
  return link;
}

Joint StructuredLoops::joint(int index) {
  Joint joint;
  joint.name = "joint_" + std::to_string(index);
  joint.child_link = index;
  const double reach = size_ * std::pow(10, random_.uniform(-spread_of_sizes_, spread_of_sizes_));
  const int kind = pick(8);
  joint.type = kind == 0  ? JointType::kFixed
               : kind < 3 ? JointType::kPrismatic
               : kind < 5 ? JointType::kContinuous
                          : JointType::kRevolute;
  const bool slides = joint.type == JointType::kPrismatic;
  switch (axes_) {
    case Axes::kAny:
      joint.p_PoKo_P = vector(0.5 * reach);
      joint.R_PK = rotation();
      joint.axis_K = direction();
      break;
    case Axes::kParallel: {
      joint.p_PoKo_P = vector(0.5 * reach);
      if (random_.chance(0.5)) joint.p_PoKo_P.z() = 0;
      if (random_.chance(0.3)) joint.p_PoKo_P.y() = 0;  // links that can lie in one line
      joint.R_PK = random_.chance(0.5) ? turn(2, random_.uniform(-3, 3)) : Matrix3l::Identity();
      const double angle = random_.uniform(-3, 3);
      joint.axis_K = slides ? Vector3l(std::cos(angle), std::sin(angle), 0).normalized()
                            : Vector3l(Vector3l::UnitZ());
      break;
    }
    case Axes::kThroughOnePoint:
      joint.R_PK = random_.chance(0.5) ? rotation() : rightAngles();
      joint.axis_K = random_.chance(0.5) ? direction() : alongAxis();
      break;
    case Axes::kInOneLine:
      joint.p_PoKo_P.z() = random_.uniform(-0.5, 0.5) * reach;
      joint.axis_K = random_.chance(0.8) ? Vector3l(Vector3l::UnitZ()) : alongAxis();
      break;
    case Axes::kAlongRoot:
      joint.p_PoKo_P = random_.uniform(0.1, 0.5) * reach * alongAxis();
      joint.R_PK = rightAngles();
      joint.axis_K = alongAxis();
      break;
  }
  if (joint.type == JointType::kFixed) joint.axis_K.setZero();
  joint.p_PoKo_P = joint.p_PoKo_P.cast<double>().cast<long double>();
  return joint;
}

void StructuredLoops::addMimics(Description& tree) {
  for (std::size_t k = 1; k < tree.joints.size(); ++k) {
    Joint& joint = tree.joints[k];
    const int master = pick(static_cast<int>(k));
    const Joint& led_by = tree.joints[static_cast<std::size_t>(master)];
    if (joint.type == JointType::kFixed || led_by.type == JointType::kFixed || led_by.mimics ||
        !random_.chance(0.3)) {
      continue;
    }
    joint.mimics = true;
    joint.coordinate = master;
    joint.multiplier = random_.chance(0.5) ? -1 : random_.uniform(0.2, 2);
    // A slide of the mechanism's size for a turn, and the other way round.
    if (joint.type == JointType::kPrismatic) joint.multiplier *= size_;
    if (led_by.type == JointType::kPrismatic) joint.multiplier /= size_;
  }
}

Mechanism StructuredLoops::mechanism() {
  Description tree;
  const int joints = 2 + pick(6), shape = pick(3);
  tree.links.push_back(link(0));
  for (int i = 1; i <= joints; ++i) {
    tree.links.push_back(link(i));
    tree.joints.push_back(joint(i));
    tree.joints.back().parent_link = shape == 0 ? i - 1 : shape == 1 ? pick(i) : std::max(0, i - 2);
  }
  if (random_.chance(0.3)) addMimics(tree);
  return tree.arranged();
}

Motion StructuredLoops::motion(const Mechanism& mechanism) {
  Motion motion(static_cast<Eigen::Index>(mechanism.coordinates().size()));
  const bool moves = random_.chance(0.7);
  for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
    const bool slides = mechanism.unitOf(static_cast<int>(i)) == Unit::kMetre;
    const double unit = slides ? size_ : 1;
    motion.q[i] = random_.uniform(-1, 1) * (slides ? 0.3 : 3) * unit;
    if (special_positions_) {
      motion.q[i] = slides ? 0 : pick(4) * (kPi / 2);
      if (beside_ > 0) motion.q[i] += beside_ * random_.uniform(-1, 1) * unit;
    }
    if (!moves) continue;
    motion.qd[i] = random_.uniform(-2, 2) * unit;
    motion.qdd[i] = random_.uniform(-5, 5) * unit;
  }
  return motion;
}

// Where a closure is: anywhere, or on the axis of a joint, with its z along that axis or not.
StructuredLoops::Placed StructuredLoops::placeOf(const Mechanism& mechanism,
                                                 const NewtonEulerOracle& bodies) {
  const int k = pick(static_cast<int>(mechanism.joints().size()));
  const Joint& joint = mechanism.joint(k);
  const Matrix3l& R_0K = bodies.orientation(k + 1);
  const Vector3l axis = R_0K * joint.axis_K;
  Placed place;
  const int where = pick(4);
  place.o = bodies.origin(k + 1);
  if (where == 1) place.o += random_.uniform(-0.5, 0.5) * size_ * axis;
  if (where > 1) place.o += vector(0.5 * size_);
  if (beside_ > 0 && random_.chance(0.5)) place.o += vector(beside_ * size_);
  const int how = pick(4);
  place.R = how == 0 ? rotation() : how == 1 ? rightAngles() : R_0K;
  if (how == 3 && joint.type != JointType::kFixed) {
    const Vector3l x = axis.unitOrthogonal();
    place.R << x, axis.cross(x), axis;
  }
  return place;
}

void StructuredLoops::freeMotion(ClosureType type, Vector3l& p, Matrix3l& R) {
  using Type = ClosureType;
  p.setZero();
  R.setIdentity();
  if (type == Type::kDistance) {
    p = random_.uniform(0.1, 0.5) * size_ * (random_.chance(0.5) ? direction() : alongAxis());
  }
  if (random_.chance(0.3)) return;
  const auto angle = [&] { return random_.uniform(-3, 3); };
  const auto slide = [&] { return random_.uniform(-0.5, 0.5) * size_; };
  if (type == Type::kRevolute || type == Type::kCylindrical || type == Type::kPlanar) {
    R = turn(2, angle());
  }
  if (type == Type::kUniversal) {
    R = turn(2, angle());
    R = R * turn(0, angle());
  }
  if (type == Type::kSpherical || type == Type::kDistance) R = rotation();
  if (type == Type::kPrismatic || type == Type::kCylindrical) p.z() = slide();
  if (type == Type::kPlanar) {
    p.x() = slide();
    p.y() = slide();
  }
}

std::optional<Closure> StructuredLoops::closure(const Mechanism& mechanism,
                                                const NewtonEulerOracle& bodies, int index) {
  const std::optional<std::pair<int, int>> links = linksThatMove(mechanism);
  if (!links) return std::nullopt;
  const auto [parent, child] = *links;
  Closure closure;
  closure.name = "closure_" + std::to_string(index);
  closure.type = static_cast<ClosureType>(pick(kTypes));
  closure.parent.link = mechanism.link(parent).name;
  closure.child.link = mechanism.link(child).name;
  const Placed place = placeOf(mechanism, bodies);
  const Matrix3l R_P0 = bodies.orientation(parent).transpose();
  const Matrix3l R_C0 = bodies.orientation(child).transpose();
  closure.parent.xyz = (R_P0 * (place.o - bodies.origin(parent))).cast<double>();
  closure.parent.rpy = rpyOf(R_P0 * place.R);
  const Matrix3l R_0F = bodies.orientation(parent) * rotationOf(closure.parent.rpy);
  Vector3l p;
  Matrix3l R;
  freeMotion(closure.type, p, R);
  closure.child.xyz = (R_C0 * (place.o + R_0F * p - bodies.origin(child))).cast<double>();
  closure.child.rpy = rpyOf(R_C0 * R_0F * R);
  return closure;
}

// The conditions of all types but one are those of parent and child exchanged.
void StructuredLoops::addCopies(Scene& scene) {
  const std::size_t count = scene.closures.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!random_.chance(0.2)) continue;
    Closure copy = scene.closures[i];
    copy.name += "_again";
    if (copy.type != ClosureType::kUniversal && random_.chance(0.5)) {
      std::swap(copy.parent, copy.child);
    }
    scene.closures.push_back(copy);
  }
}

void StructuredLoops::addLoads(const Mechanism& mechanism, Scene& scene) {
  scene.gravity = kGravity * direction().cast<double>();
  if (random_.chance(0.2)) scene.gravity.setZero();
  scene.static_motion = random_.chance(0.1);
  const double force = mass_ * kGravity;
  for (int i = pick(3); i > 0; --i) {
    AppliedWrench applied;
    applied.link = mechanism.link(pick(static_cast<int>(mechanism.links().size()))).name;
    applied.at = vector(0.5 * size_).cast<double>();
    applied.axes = random_.chance(0.5) ? virtual_work_dynamics::Axes::kLink
                                       : virtual_work_dynamics::Axes::kRoot;
    applied.force = vector(force).cast<double>();
    applied.torque = vector(force * size_).cast<double>();
    scene.applied_wrenches.push_back(applied);
  }
  if (!random_.chance(0.3)) return;
  PointSpring spring;
  spring.name = "spring";
  spring.link_a = mechanism.links().front().name;
  spring.link_b = mechanism.links().back().name;
  spring.at_a = vector(0.5 * size_).cast<double>();
  spring.at_b = vector(0.5 * size_).cast<double>();
  spring.stiffness = force / size_;
  spring.rest_length = random_.uniform(0, 0.5) * size_;
  scene.springs.push_back(spring);
}

void StructuredLoops::chooseActuated(const Mechanism& mechanism, Scene& scene) {
  if (random_.chance(0.1)) return;
  const double share = random_.uniform(0.2, 1);
  scene.actuated.emplace();
  for (const std::string& name : mechanism.coordinateNames()) {
    if (random_.chance(share)) scene.actuated->push_back(name);
  }
  for (const Closure& closure : scene.closures) {
    const bool one_axis =
        closure.type == ClosureType::kRevolute || closure.type == ClosureType::kPrismatic;
    if (one_axis && random_.chance(0.2)) scene.actuated->push_back(closure.name);
  }
}

void StructuredLoops::chooseRedundancy(const Mechanism& mechanism, Scene& scene) {
  Redundancy& redundancy = scene.redundancy;
  redundancy.policy = static_cast<RedundancyPolicy>(pick(3));
  if (redundancy.policy == RedundancyPolicy::kZeroAt) {
    redundancy.zero_at.push_back(scene.closures.front().name);
  }
  if (redundancy.policy == RedundancyPolicy::kStiffness) {
    redundancy.stiffness.push_back({scene.closures.back().name, random_.uniform(0.1, 10)});
    redundancy.stiffness.push_back({mechanism.coordinateNames().front(), random_.uniform(0.1, 10)});
  }
}

ClosedCase StructuredLoops::next() {
  for (;;) {
    chooseStyle();
    Mechanism tree = mechanism();
    if (tree.coordinates().empty()) continue;
    Motion state = motion(tree);
    Scene scene;
    const NewtonEulerOracle bodies(tree, scene, state);
    for (int i = 0, count = 1 + pick(3); i < count; ++i) {
      const std::optional<Closure> made = closure(tree, bodies, i);
      if (made) scene.closures.push_back(*made);
    }
    if (scene.closures.empty()) continue;
    addCopies(scene);
    addLoads(tree, scene);
    chooseActuated(tree, scene);
    chooseRedundancy(tree, scene);
    for (std::size_t i = 0; i < tree.coordinates().size(); ++i) {
      scene.assembly.push_back({tree.coordinateNames()[i], state.q[static_cast<Eigen::Index>(i)]});
    }
    return {std::move(tree), std::move(scene), std::move(state), wayOfAxes()};
  }
}

}  // namespace virtual_work_dynamics
