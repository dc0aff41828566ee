#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "newton_euler_oracle.h"
#include "random_cases.h"
#include "touch_geometry.h"

namespace virtual_work_dynamics {

/// Random trees with closures of all types, springs, and actuated joints and closures. The loops
/// are closed at the positions of the motion, which are the scene's assembly. Velocities and
/// accelerations do not satisfy the loops, as forces do not need that. Actuated joints may be too
/// few.
class RandomLoops {
 public:
  /// @param touching whether there are wheels, blades and points on planes, and cylinders, too
  explicit RandomLoops(unsigned seed, bool touching = false) : touching_(touching), cases_(seed) {}

  Case next() {
    Case random = cases_.next(3 + cases_.pick(7));
    // A tree without coordinates has nothing to solve.
    while (random.mechanism.coordinates().empty()) random = cases_.next(3 + cases_.pick(7));
    Scene& scene = random.scene;
    scene.reactions = ReactionSelection::kAll;
    scene.reaction_names.clear();
    scene.include_active = true;
    scene.use_urdf_dynamics = false;
    const NewtonEulerOracle bodies(random.mechanism, scene, random.motion);
    for (int i = 0, count = 1 + cases_.pick(3); i < count; ++i) {
      scene.closures.push_back(closure(random.mechanism, bodies, i));
    }
    for (int i = 0, count = cases_.pick(3); i < count; ++i) {
      scene.springs.push_back(spring(random.mechanism, i));
    }
    chooseActuated(random.mechanism, scene);
    scene.redundancy = redundancy(random.mechanism, scene);
    for (std::size_t i = 0; i < random.mechanism.coordinates().size(); ++i) {
      scene.assembly.push_back(
          {random.mechanism.coordinateNames()[i], random.motion.q[static_cast<Eigen::Index>(i)]});
    }
    return random;
  }

 private:
  static Matrix3l turn(int axis, long double angle) {
    return Eigen::AngleAxis<long double>(angle, Vector3l::Unit(axis)).toRotationMatrix();
  }

  static Eigen::Vector3d rpyOf(const Matrix3l& R) {
    return Eigen::Matrix<long double, 3, 1>(std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)),
                                            std::atan2(R(1, 0), R(0, 0)))
        .cast<double>();
  }

  static Matrix3l rotationOf(const Eigen::Vector3d& rpy) {
    return turn(2, rpy.z()) * turn(1, rpy.y()) * turn(0, rpy.x());
  }

  // A random displacement and turn of the child in the parent frame that the type leaves free.
  void freeMotion(ClosureType type, Vector3l& p, Matrix3l& R) {
    using Type = ClosureType;
    p.setZero();
    R.setIdentity();
    if (type == Type::kRevolute || type == Type::kCylindrical || type == Type::kPlanar) {
      R = turn(2, cases_.uniform(-3, 3));
    }
    if (type == Type::kUniversal) {
      R = turn(2, cases_.uniform(-3, 3)) * turn(0, cases_.uniform(-3, 3));
    }
    if (type == Type::kSpherical || type == Type::kDistance || type == Type::kCylinder) {
      R = cases_.rotation();
    }
    if (type == Type::kPrismatic || type == Type::kCylindrical) p.z() = cases_.uniform(-0.5, 0.5);
    if (type == Type::kPlanar) p = {cases_.uniform(-0.5, 0.5), cases_.uniform(-0.5, 0.5), 0};
    if (type == Type::kDistance || type == Type::kCylinder) p = cases_.vector(0.5);
  }

  // The joints between a link and the root that move the link.
  static std::set<int> moversOf(const Mechanism& mechanism, int link) {
    std::set<int> movers;
    while (link > 0) {
      const int k = mechanism.links()[static_cast<std::size_t>(link)].parent_joint;
      const Joint& joint = mechanism.joints()[static_cast<std::size_t>(k)];
      if (joint.coordinate >= 0) movers.insert(k);
      link = joint.parent_link;
    }
    return movers;
  }

  Closure closure(const Mechanism& mechanism, const NewtonEulerOracle& bodies, int index) {
    const int links = static_cast<int>(mechanism.links().size());
    int parent = 0, child = 0;
    while (moversOf(mechanism, parent) == moversOf(mechanism, child)) {
      parent = cases_.pick(links);
      child = cases_.pick(links);
    }
    Closure closure;
    closure.name = "closure_" + std::to_string(index);
    const bool higher = touching_ && cases_.chance(0.6);
    closure.type = static_cast<ClosureType>(higher ? 8 + cases_.pick(4) : cases_.pick(8));
    closure.parent.link = mechanism.links()[static_cast<std::size_t>(parent)].name;
    closure.parent.xyz = cases_.doubles(0.5);
    closure.parent.rpy = rpyOf(cases_.rotation());
    if (higher && closure.type != ClosureType::kCylinder) {
      return touch(mechanism, bodies, parent, child, closure);
    }
    Vector3l p;
    Matrix3l R;
    freeMotion(closure.type, p, R);
    const Matrix3l R_parent = bodies.orientation(parent) * rotationOf(closure.parent.rpy);
    const Vector3l o = bodies.origin(parent) +
                       bodies.orientation(parent) * closure.parent.xyz.cast<long double>() +
                       R_parent * p;
    const Matrix3l R_0L = bodies.orientation(child).transpose();
    closure.child.link = mechanism.links()[static_cast<std::size_t>(child)].name;
    closure.child.xyz = (R_0L * (o - bodies.origin(child))).cast<double>();
    closure.child.rpy = rpyOf(R_0L * R_parent * R);
    if (closure.type == ClosureType::kDistance && cases_.chance(0.5)) {
      closure.length = static_cast<double>(p.norm());
    }
    return closure;
  }

  // What touches lies at random on its link; its plane, of random directions, where it touches.
  Closure touch(const Mechanism& mechanism, const NewtonEulerOracle& bodies, int parent, int child,
                Closure closure) {
    Touch& touch = closure.touch;
    closure.child.link = mechanism.links()[static_cast<std::size_t>(child)].name;
    closure.child.xyz = cases_.doubles(0.5);
    closure.child.rpy = rpyOf(cases_.rotation());
    touch.normal = cases_.chance(0.7);
    if (closure.type == ClosureType::kRolling) {
      touch.radius = cases_.chance(0.1) ? 0 : cases_.uniform(0.05, 0.5);
      touch.tube_radius = touch.radius == 0 || cases_.chance(0.3) ? cases_.uniform(0.01, 0.1) : 0;
      touch.slip = static_cast<Slip>(cases_.pick(touch.normal ? 4 : 3));
      if (cases_.chance(0.2)) touch.roller_angle = cases_.uniform(-1.5, 1.5);
    }
    if (closure.type == ClosureType::kContact) {
      touch.normal = true;
      touch.slip = cases_.chance(0.3) ? Slip::kAll : Slip::kNone;
      touch.closed = cases_.chance(0.8);
    }
    const PlacedTouch placed(mechanism, bodies, closure);
    const Matrix3l R_0L = bodies.orientation(parent).transpose();
    const Vector3l shift{cases_.uniform(-0.5, 0.5), cases_.uniform(-0.5, 0.5), 0};
    const Vector3l in_parent =
        R_0L * (placed.o - bodies.origin(parent)) + rotationOf(closure.parent.rpy) * shift;
    closure.parent.xyz = in_parent.cast<double>();
    return closure;
  }

  PointSpring spring(const Mechanism& mechanism, int index) {
    const int links = static_cast<int>(mechanism.links().size());
    const int a = cases_.pick(links);
    PointSpring spring;
    spring.name = "spring_" + std::to_string(index);
    spring.link_a = mechanism.links()[static_cast<std::size_t>(a)].name;
    spring.link_b =
        mechanism.links()[static_cast<std::size_t>((a + 1 + cases_.pick(links - 1)) % links)].name;
    spring.at_a = cases_.doubles(0.5);
    spring.at_b = cases_.doubles(0.5);
    spring.stiffness = cases_.uniform(0, 100);
    spring.rest_length = cases_.uniform(0, 0.5);
    return spring;
  }

  void chooseActuated(const Mechanism& mechanism, Scene& scene) {
    if (cases_.chance(0.2)) return;
    const double share = cases_.uniform(0.3, 1);
    scene.actuated.emplace();
    for (const std::string& name : mechanism.coordinateNames()) {
      if (cases_.chance(share)) scene.actuated->push_back(name);
    }
    for (const Closure& closure : scene.closures) {
      const bool one_axis =
          closure.type == ClosureType::kRevolute || closure.type == ClosureType::kPrismatic;
      if (one_axis && cases_.chance(0.4)) scene.actuated->push_back(closure.name);
    }
  }

  Redundancy redundancy(const Mechanism& mechanism, const Scene& scene) {
    Redundancy redundancy;
    redundancy.policy = static_cast<RedundancyPolicy>(cases_.pick(3));
    if (redundancy.policy == RedundancyPolicy::kZeroAt) {
      redundancy.zero_at.push_back(scene.closures.front().name);
    }
    if (redundancy.policy == RedundancyPolicy::kStiffness) {
      redundancy.stiffness.push_back({scene.closures.back().name, cases_.uniform(0.1, 10)});
      redundancy.stiffness.push_back(
          {mechanism.coordinateNames().front(), cases_.uniform(0.1, 10)});
    }
    if (cases_.chance(0.5)) redundancy.length = cases_.uniform(0.1, 2);
    for (const std::string& name : mechanism.coordinateNames()) {
      const bool actuated =
          !scene.actuated || std::count(scene.actuated->begin(), scene.actuated->end(), name) > 0;
      if (actuated && cases_.chance(0.2)) {
        redundancy.effort_weights.push_back({name, cases_.uniform(0.1, 10)});
      }
    }
    return redundancy;
  }

  bool touching_;
  RandomCases cases_;
};

}  // namespace virtual_work_dynamics
