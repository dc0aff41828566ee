#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {

constexpr double kHeldGravity = 9.81;

inline LinkFrame frameAt(const std::string& link, const Eigen::Vector3d& xyz) {
  LinkFrame frame;
  frame.link = link;
  frame.xyz = xyz;
  return frame;
}

inline Closure closureOf(ClosureType type, const LinkFrame& parent, const LinkFrame& child) {
  Closure closure;
  closure.name = "closure";
  closure.type = type;
  closure.parent = parent;
  closure.child = child;
  return closure;
}

/// A mechanism with one passive coordinate at zero and a closure that holds it with a lever, or a
/// slope, of y.
struct Held {
  std::string name;
  Mechanism mechanism;
  Scene scene;
  double size;   // of a row without cancellation, over the length
  double lever;  // what is left of it
  std::function<double(const ClosedLoopResults&)> bearing;  // what balances the load
  double load;
};

inline RobotBuilder armOf(JointType type, const Vector3l& axis, const Vector3l& centre) {
  RobotBuilder builder(1);
  builder.add(type, 0, axis, Matrix3l::Identity(), Vector3l::Zero());
  builder.removeInertia(1);
  builder.link(1).mass = 1;
  builder.link(1).p_KoCm_K = centre;
  return builder;
}

inline Scene sceneOf(const Eigen::Vector3d& gravity, const Closure& closure) {
  Scene scene;
  scene.gravity = gravity;
  scene.closures = {closure};
  scene.actuated.emplace();
  return scene;
}

inline double forceAlong(const ClosedLoopResults& results, const Eigen::Vector3d& direction) {
  return std::abs(results.root("closure").force.dot(direction));
}

// The arm's rod points from its end (1, 0, 0) to an anchor that is y beside the line of the arm.
inline Held rodOnArm(double y) {
  const Eigen::Vector3d along = Eigen::Vector3d(1, y, 0).normalized();
  return {
      "rod on an arm",
      armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0)).build(),
      sceneOf({0, -kHeldGravity, 0}, closureOf(ClosureType::kDistance, frameAt("link_1", {1, 0, 0}),
                                               frameAt("link_0", {2, y, 0}))),
      1,
      along.y() / std::hypot(2, y),
      [along](const ClosedLoopResults& results) { return forceAlong(results, along); },
      kHeldGravity / 2 / std::hypot(2, y)};
}

inline Held rodOnSlide(double y) {
  const Eigen::Vector3d along = Eigen::Vector3d(y, 1, 0).normalized();
  return {
      "rod on a slide",
      armOf(JointType::kPrismatic, Vector3l::UnitX(), Vector3l::Zero()).build(),
      sceneOf({kHeldGravity, 0, 0}, closureOf(ClosureType::kDistance, frameAt("link_1", {0, 0, 0}),
                                              frameAt("link_0", {y, 1, 0}))),
      1,
      along.x(),
      [along](const ClosedLoopResults& results) { return forceAlong(results, along); },
      kHeldGravity};
}

// A guide across the slide, turned by y out of the slide's direction.
inline Held guideOnSlide(double y) {
  const double slope = std::atan(y);
  return {"guide along a slide",
          armOf(JointType::kPrismatic, Vector3l::UnitX(), Vector3l::Zero()).build(),
          sceneOf({kHeldGravity, 0, 0},
                  closureOf(ClosureType::kCylindrical,
                            {"link_0", {0, 0.3, 0}, {0, std::acos(0.0) + slope, 0}},
                            {"link_1", {0, 0.3, 0}, {0, std::acos(0.0) + slope, 0}})),
          1,
          std::sin(slope),
          [slope](const ClosedLoopResults& results) {
            return forceAlong(results, {std::sin(slope), 0, std::cos(slope)});
          },
          kHeldGravity};
}

// A plane in which the arm may move when its normal is the joint's axis.
inline Held planeOnArm(double y) {
  const double slope = std::atan(y);
  return {"plane of an arm",
          armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0)).build(),
          sceneOf({0, -kHeldGravity, 0},
                  closureOf(ClosureType::kPlanar, {"link_0", {1, 0, 0}, {slope, 0, 0}},
                            {"link_1", {1, 0, 0}, {slope, 0, 0}})),
          1,
          std::sqrt(2) * std::sin(slope),  // of a force and a moment
          [slope](const ClosedLoopResults& results) {
            const Wrench& wrench = results.root("closure");
            return std::abs(wrench.torque.z() + wrench.force.y()) /
                   (std::sqrt(2) * std::sin(slope));
          },
          kHeldGravity / 2};
}

// Two joints in one line, the second a mimic of the first, that together turn the arm by 3 q.
inline Held rodOnMimic(double y) {
  RobotBuilder builder = armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0));
  builder.removeInertia(1);
  builder.add(JointType::kContinuous, 1, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
  builder.mimicFirst(2, 0);
  builder.removeInertia(2);
  builder.link(2).mass = 1;
  builder.link(2).p_KoCm_K << 0.5L, 0, 0;
  const Eigen::Vector3d along = Eigen::Vector3d(1, y, 0).normalized();
  return {
      "rod on a mimic",
      builder.build(),
      sceneOf({0, -kHeldGravity, 0}, closureOf(ClosureType::kDistance, frameAt("link_2", {1, 0, 0}),
                                               frameAt("link_0", {2, y, 0}))),
      3,
      3 * along.y() / std::hypot(2, y),
      [along](const ClosedLoopResults& results) { return forceAlong(results, along); },
      3 * kHeldGravity / 2 / std::hypot(2, y)};
}

// A ball on the arm, far out on the joint's axis and y beside it.
inline Held ballOnAxis(double y) {
  return {"ball on an axis",
          armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0)).build(),
          sceneOf({0, -kHeldGravity, 0},
                  closureOf(ClosureType::kSpherical, frameAt("link_0", {y, 0, 1}),
                            frameAt("link_1", {y, 0, 1}))),
          1,
          y / std::hypot(1, y),
          [](const ClosedLoopResults& results) {
            return forceAlong(results, {0, 1, 0});
          },
          kHeldGravity / 2 / std::hypot(1, y)};
}

inline const std::vector<std::function<Held(double)>> kHeldMechanisms{
    rodOnArm, rodOnSlide, guideOnSlide, planeOnArm, rodOnMimic, ballOnAxis};

}  // namespace virtual_work_dynamics
