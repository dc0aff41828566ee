#include "stability/mixed_loops.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "touch_geometry.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kGravity = 9.81;
// Sine of the angle between what rolls or cuts and the normal of its plane, at least.
constexpr long double kLeastLean = 0.1L;

std::string kindsOf(const Scene& scene) {
  std::set<std::string> kinds;
  for (const Closure& closure : scene.closures) {
    const bool mesh = isMesh(closure), touch = isTouch(closure);
    const bool cylinder = closure.type == ClosureType::kCylinder;
    kinds.insert(mesh ? "teeth" : touch ? "touches" : cylinder ? "cylinders" : "closures");
  }
  if (!scene.couplings.empty()) kinds.insert("couplings");
  std::string text;
  for (const std::string& kind : kinds) text += ", " + kind;
  return text;
}

}  // namespace

MixedLoops::Geared MixedLoops::gearedLink(Description& tree, int parent, const Vector3l& at,
                                          const Matrix3l& R, JointType type) {
  const int index = static_cast<int>(tree.links.size());
  const Matrix3l axes = random_.chance(0.5) ? rightAngles() : rotation();
  tree.links.push_back(link(index));
  Joint joint;
  joint.name = "joint_" + std::to_string(index);
  joint.parent_link = parent;
  joint.child_link = index;
  joint.type = type;
  joint.p_PoKo_P = at;
  joint.R_PK = R * axes.transpose();
  if (type == JointType::kPrismatic) joint.axis_K = axes.col(0);
  if (type == JointType::kContinuous) {
    joint.axis_K = (random_.chance(0.5) ? -1 : 1) * axes.col(2);
  }
  tree.joints.push_back(joint);
  return {tree.links.back().name, axes};
}

LinkFrame MixedLoops::frameOf(const Geared& geared, double height) {
  LinkFrame frame;
  frame.link = geared.name;
  frame.xyz = (geared.axes.col(2) * height).cast<double>();
  frame.rpy = rpyOf(geared.axes);
  return frame;
}

void MixedLoops::mesh(ClosureType type, const Geared& parent, const Geared& child,
                      double parent_radius, double child_radius) {
  Closure closure;
  closure.name = name("teeth_");
  closure.type = type;
  closure.parent = frameOf(parent, random_.uniform(-0.2, 0.2) * size_);
  closure.child = frameOf(child, random_.uniform(-0.2, 0.2) * size_);
  closure.teeth.parent_radius = parent_radius;
  closure.teeth.child_radius = child_radius;
  if (random_.chance(0.5)) closure.teeth.pressure_angle = random_.uniform(0, 0.5);
  if (random_.chance(0.5)) closure.teeth.helix_angle = random_.uniform(-0.6, 0.6);
  teeth_.push_back(closure);
}

// Of a ring and a wheel in it, the ring's radius is negative.
void MixedLoops::addPair(Description& tree, int base, const Vector3l& at, const Matrix3l& R) {
  double one = random_.uniform(0.1, 0.5) * size_;
  const double other = random_.uniform(0.1, 0.5) * size_;
  if (random_.chance(0.3)) one = -(one + other);
  const double angle = random_.uniform(-3, 3), distance = std::abs(one + other);
  const Vector3l across(distance * std::cos(angle), distance * std::sin(angle),
                        random_.uniform(-0.3, 0.3) * size_);
  const Geared first = gearedLink(tree, base, at, R, JointType::kContinuous);
  const Geared second = gearedLink(tree, base, at + R * across, R, JointType::kContinuous);
  if (random_.chance(0.5)) {
    mesh(ClosureType::kGear, first, second, one, other);
  } else {
    mesh(ClosureType::kGear, second, first, other, one);
  }
}

void MixedLoops::addRack(Description& tree, int base, const Vector3l& at, const Matrix3l& R) {
  const double radius = random_.uniform(0.1, 0.5) * size_;
  const Vector3l away(random_.uniform(-0.5, 0.5) * size_, random_.chance(0.5) ? -radius : radius,
                      random_.uniform(-0.3, 0.3) * size_);
  const Geared wheel = gearedLink(tree, base, at, R, JointType::kContinuous);
  const Geared rack = gearedLink(tree, base, at + R * away, R, JointType::kPrismatic);
  mesh(ClosureType::kRack, wheel, rack, radius, 0);
}

// The planet turns on its carrier, between a sun and a ring that may be fixed.
void MixedLoops::addPlanets(Description& tree, int base, const Vector3l& at, const Matrix3l& R) {
  const double sun_radius = random_.uniform(0.1, 0.4) * size_;
  const double radius = random_.uniform(0.1, 0.4) * size_;
  const Geared carrier = gearedLink(tree, base, at, R, JointType::kContinuous);
  const int on = static_cast<int>(tree.links.size()) - 1;
  const Geared sun = gearedLink(tree, base, at, R, JointType::kContinuous);
  const bool turns = random_.chance(0.5);
  const Geared ring =
      gearedLink(tree, base, at, R, turns ? JointType::kContinuous : JointType::kFixed);
  for (int i = 1 + pick(2); i > 0; --i) {
    const double angle = random_.uniform(-3, 3), distance = sun_radius + radius;
    const Vector3l across(distance * std::cos(angle), distance * std::sin(angle), 0);
    const Geared planet =
        gearedLink(tree, on, carrier.axes * across, carrier.axes, JointType::kContinuous);
    mesh(ClosureType::kGear, sun, planet, sun_radius, radius);
    mesh(ClosureType::kGear, planet, ring, radius, -(sun_radius + 2 * radius));
  }
}

void MixedLoops::addGears(Description& tree) {
  Vector3l at = vector(0.5 * size_);
  if (axes_ == Axes::kThroughOnePoint) at.setZero();
  if (axes_ == Axes::kInOneLine) at.head<2>().setZero();
  Matrix3l R = Matrix3l::Identity();
  if (axes_ == Axes::kAny) R = rotation();
  if (axes_ == Axes::kAlongRoot || axes_ == Axes::kThroughOnePoint) R = rightAngles();
  const int base = pick(static_cast<int>(tree.links.size())), kind = pick(4);
  if (kind == 0) {
    addRack(tree, base, at, R);
  } else if (kind == 1) {
    addPlanets(tree, base, at, R);
  } else {
    addPair(tree, base, at, R);
  }
}

Mechanism MixedLoops::mixedMechanism() {
  Description tree;
  teeth_.clear();
  tree.links.push_back(link(0));
  const int gears = random_.chance(0.6) ? 1 + pick(2) : 0;
  const int before = 1 + pick(3), after = 1 + pick(3);
  const auto addJoint = [&] {
    const int index = static_cast<int>(tree.links.size());
    tree.links.push_back(link(index));
    tree.joints.push_back(joint(index));
    tree.joints.back().parent_link = random_.chance(0.5) ? index - 1 : pick(index);
  };
  for (int i = 0; i < before; ++i) addJoint();
  for (int i = 0; i < gears; ++i) addGears(tree);
  for (int i = 0; i < after; ++i) addJoint();
  if (random_.chance(0.3)) addMimics(tree);
  return tree.arranged();
}

Touch MixedLoops::touch(ClosureType type) {
  Touch touch;
  touch.normal = type == ClosureType::kContact || random_.chance(0.7);
  if (type == ClosureType::kRolling) {
    touch.radius = random_.chance(0.1) ? 0 : random_.uniform(0.05, 0.5) * size_;
    const bool tube = touch.radius == 0 || random_.chance(0.3);
    if (tube) touch.tube_radius = random_.uniform(0.01, 0.1) * size_;
    touch.slip = static_cast<Slip>(pick(touch.normal ? 4 : 3));
    if (random_.chance(0.2)) touch.roller_angle = random_.uniform(-1.5, 1.5);
  }
  if (type == ClosureType::kContact && random_.chance(0.3)) touch.slip = Slip::kAll;
  if (touch.normal && touch.slip != Slip::kAll && random_.chance(0.3)) touch.friction = 0.5;
  touch.closed = random_.chance(0.85);
  return touch;
}

// Axes of what touches, on its link: an axle or blade that leans, or lies in the plane.
Eigen::Vector3d MixedLoops::childAxes(ClosureType type, const Matrix3l& R_0L,
                                      const Matrix3l& R_plane) {
  const int along = type == ClosureType::kRolling ? 2 : 0;
  for (;;) {
    Matrix3l R = rotation();
    if (random_.chance(0.5)) R = R_plane * turn(2, random_.uniform(-3, 3)) * rightAngles();
    if (R_plane.col(2).cross(R.col(along)).norm() > kLeastLean) return rpyOf(R_0L * R);
  }
}

// One or several on a plane, which lies anywhere or on the axis of a joint.
void MixedLoops::addTouches(const Mechanism& mechanism, const NewtonEulerOracle& bodies,
                            Scene& scene) {
  const auto links = linksThatMove(mechanism);
  if (!links) return;
  const auto [parent, child] = *links;
  const Placed place = placeOf(mechanism, bodies);
  const Matrix3l R_P0 = bodies.orientation(parent).transpose();
  const Matrix3l R_C0 = bodies.orientation(child).transpose();
  const bool alike = random_.chance(0.3);
  const int first = pick(3);
  for (int i = random_.chance(0.6) ? 1 : 2 + pick(3); i > 0; --i) {
    constexpr ClosureType kTouching[] = {ClosureType::kRolling, ClosureType::kContact,
                                         ClosureType::kKnifeEdge};
    Closure closure;
    closure.name = name("touch_");
    closure.type = kTouching[alike ? first : pick(3)];
    closure.touch = touch(closure.type);
    closure.parent.link = mechanism.link(parent).name;
    closure.parent.xyz = (R_P0 * (place.o - bodies.origin(parent))).cast<double>();
    closure.parent.rpy = rpyOf(R_P0 * place.R);
    const PlacedFrame plane(mechanism, bodies, closure.parent);
    closure.child.link = mechanism.link(child).name;
    closure.child.rpy = childAxes(closure.type, R_C0, plane.R);
    const Vector3l there = plane.o + plane.R * Vector3l(random_.uniform(-0.5, 0.5) * size_,
                                                        random_.uniform(-0.5, 0.5) * size_, 0);
    const PlacedTouch placed(mechanism, bodies, closure);
    closure.child.xyz = (R_C0 * (there - placed.o)).cast<double>();
    scene.closures.push_back(closure);
  }
}

void MixedLoops::addCylinder(const Mechanism& mechanism, const NewtonEulerOracle& bodies,
                             Scene& scene) {
  const auto links = linksThatMove(mechanism);
  if (!links) return;
  Closure closure;
  closure.name = name("cylinder_");
  closure.type = ClosureType::kCylinder;
  closure.parent.link = mechanism.link(links->first).name;
  closure.child.link = mechanism.link(links->second).name;
  do {
    closure.parent.xyz = vector(0.5 * size_).cast<double>();
    closure.child.xyz = vector(0.5 * size_).cast<double>();
  } while ((PlacedFrame(mechanism, bodies, closure.parent).o -
            PlacedFrame(mechanism, bodies, closure.child).o)
               .norm() < 0.1L * size_);
  closure.pulls_only = random_.chance(0.5);
  scene.closures.push_back(closure);
}

// Factors of slides are per length of the mechanism.
void MixedLoops::addCouplings(const Mechanism& mechanism, Scene& scene) {
  std::vector<const Joint*> moving;
  for (const Joint& joint : mechanism.joints()) {
    if (joint.coordinate >= 0) moving.push_back(&joint);
  }
  for (int i = 1 + pick(2); i > 0; --i) {
    Coupling coupling;
    coupling.name = name("coupling_");
    coupling.rate_only = random_.chance(0.2);
    std::set<int> used;
    bool slides = false;
    for (int terms = 1 + pick(3); terms > 0; --terms) {
      const Joint& joint = *moving[static_cast<std::size_t>(pick(static_cast<int>(moving.size())))];
      if (!used.insert(joint.coordinate).second) continue;
      const bool slide = joint.type == JointType::kPrismatic;
      if (coupling.terms.empty()) slides = slide;
      const double unit = slide == slides ? 1 : slide ? 1 / size_ : size_;
      coupling.terms.push_back(
          {joint.name, (random_.chance(0.5) ? -1 : 1) * unit *
                           (random_.chance(0.3) ? 1 : random_.uniform(0.2, 3))});
    }
    scene.couplings.push_back(coupling);
    if (!random_.chance(0.2)) continue;
    coupling.name += "_again";
    for (NamedNumber& term : coupling.terms) term.value *= -2;
    scene.couplings.push_back(coupling);
  }
}

void MixedLoops::addTerms(const Mechanism& mechanism, Scene& scene) {
  for (const Joint& joint : mechanism.joints()) {
    if (joint.coordinate < 0 || !random_.chance(0.3)) continue;
    const bool slides = joint.type == JointType::kPrismatic;
    const double effort = mass_ * kGravity * (slides ? 1 : size_), way = slides ? size_ : 1;
    JointTerms terms;
    terms.joint = joint.name;
    terms.stiffness = effort / way * random_.uniform(0, 1);
    terms.rest = way * random_.uniform(-1, 1);
    terms.damping = effort / way * random_.uniform(0, 1);
    terms.coulomb = effort * random_.uniform(0, 1);
    terms.coulomb_velocity = std::max(1e-12, way * random_.uniform(1e-3, 1));
    terms.rotor_inertia = effort / way / kGravity * random_.uniform(0, 1);
    terms.offset = effort * random_.uniform(-1, 1);
    scene.joints.push_back(terms);
  }
}

void MixedLoops::addBodies(const Mechanism& mechanism, Scene& scene) {
  const int links = static_cast<int>(mechanism.links().size());
  for (int i = pick(3); i > 0; --i) {
    Payload payload;
    payload.link = mechanism.link(pick(links)).name;
    payload.mass = std::clamp(mass_ * random_.uniform(0.1, 3), 1e-12, 1e12);
    payload.at = vector(0.3 * size_).cast<double>();
    const double a = random_.uniform(0, 0.1) * size_, b = random_.uniform(0, 0.1) * size_;
    payload.inertia.diagonal() << b * b, a * a, a * a + b * b;
    payload.inertia *= payload.mass;
    scene.payloads.push_back(payload);
  }
  for (PointSpring& spring : scene.springs) {
    if (random_.chance(0.5)) spring.damping = spring.stiffness * random_.uniform(0, 1);
  }
}

void MixedLoops::moveRoot(Scene& scene, Motion& motion) {
  scene.root_moves = random_.chance(0.4);
  if (!scene.root_moves) return;
  RootMotion& root = motion.root;
  root.position = vector(size_).cast<double>();
  root.orientation = Eigen::Quaterniond(rotation().cast<double>()).normalized();
  root.velocity = vector(2 * size_).cast<double>();
  root.angular_velocity = vector(2).cast<double>();
  root.acceleration = vector(5 * size_).cast<double>();
  root.angular_acceleration = vector(5).cast<double>();
}

void MixedLoops::chooseForces(const Mechanism& mechanism, Scene& scene) {
  chooseActuated(mechanism, scene);
  scene.free_motion = scene.actuated && random_.chance(0.5);
  if (!scene.closures.empty()) {
    chooseRedundancy(mechanism, scene);
  } else {
    scene.redundancy.policy = RedundancyPolicy::kMinimumNorm;
  }
  if (random_.chance(0.2)) scene.redundancy.length = random_.uniform(0.1, 2) * size_;
}

void MixedLoops::addConditions(const Mechanism& mechanism, const NewtonEulerOracle& bodies,
                               Scene& scene) {
  for (int i = pick(3); i > 0; --i) {
    const std::optional<Closure> made = closure(mechanism, bodies, ++names_);
    if (made) scene.closures.push_back(*made);
  }
  addCopies(scene);
  for (const Closure& teeth : teeth_) scene.closures.push_back(teeth);
  for (int i = pick(3); i > 0; --i) addTouches(mechanism, bodies, scene);
  if (random_.chance(0.4)) addCylinder(mechanism, bodies, scene);
  if (random_.chance(0.4)) addCouplings(mechanism, scene);
}

ClosedCase MixedLoops::next() {
  for (;;) {
    chooseStyle();
    names_ = 0;
    Mechanism tree = mixedMechanism();
    if (tree.coordinates().empty()) continue;
    Motion state = motion(tree);
    Scene scene;
    const NewtonEulerOracle bodies(tree, scene, state);
    addConditions(tree, bodies, scene);
    if (scene.closures.empty() && scene.couplings.empty()) continue;
    addLoads(tree, scene);
    addTerms(tree, scene);
    addBodies(tree, scene);
    chooseForces(tree, scene);
    moveRoot(scene, state);
    for (std::size_t i = 0; i < tree.coordinates().size(); ++i) {
      scene.assembly.push_back({tree.coordinateNames()[i], state.q[static_cast<Eigen::Index>(i)]});
    }
    const std::string kind = wayOfAxes() + kindsOf(scene);
    return {std::move(tree), std::move(scene), std::move(state), kind};
  }
}

}  // namespace virtual_work_dynamics
