#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "held_mechanisms.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

// Mechanisms that are assembled from starts at which their loops are open.

/// The scene with an assembly that starts at `q`.
inline Scene startingAt(Scene scene, const Mechanism& mechanism, const Eigen::VectorXd& q) {
  scene.assembly.clear();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    scene.assembly.push_back({mechanism.coordinateNames()[static_cast<std::size_t>(i)], q[i]});
  }
  return scene;
}

/// The scene with the parent and child of each closure exchanged, except for universal ones, whose
/// frames are of different use: z of the parent's and x of the child's.
inline Scene exchanged(Scene scene) {
  for (Closure& closure : scene.closures) {
    if (closure.type != ClosureType::kUniversal) std::swap(closure.parent, closure.child);
  }
  return scene;
}

/// Two thighs that hang down, half a distance left and right, with shins whose feet are pinned.
struct Leg {
  static constexpr double kHip = 0.05, kThigh = 0.12, kShin = 0.25;

  Leg() : mechanism(make()) {
    scene.closures = {closureOf(ClosureType::kRevolute, frameAt("link_2", {0, -kShin, 0}),
                                frameAt("link_4", {0, -kShin, 0}))};
    scene.actuated = std::vector<std::string>{"joint_1", "joint_3"};
  }
  static Mechanism make() {
    RobotBuilder builder(1);
    const Vector3l z = Vector3l::UnitZ(), down(0, -kThigh, 0);
    builder.add(JointType::kContinuous, 0, z, Matrix3l::Identity(), Vector3l(-kHip, 0, 0));
    builder.add(JointType::kContinuous, 1, z, Matrix3l::Identity(), down);
    builder.add(JointType::kContinuous, 0, z, Matrix3l::Identity(), Vector3l(kHip, 0, 0));
    builder.add(JointType::kContinuous, 3, z, Matrix3l::Identity(), down);
    return builder.build();
  }
  static double closedKnee() { return std::asin(kHip / kShin); }

  Mechanism mechanism;
  Scene scene;
};

/// A bar on parallel cranks of one length, driven at the first: one redundant constraint in the
/// plane for each crank after the second.
struct Cranks {
  static constexpr double kCrank = 0.3;

  explicit Cranks(int cranks) : mechanism(make(cranks)) {
    for (int i = 1; i < cranks; ++i) {
      scene.closures.push_back(closureOf(ClosureType::kRevolute,
                                         frameAt("link_" + std::to_string(i + 2), {kCrank, 0, 0}),
                                         frameAt("link_2", {double(i), 0, 0})));
      scene.closures.back().name = "pin_" + std::to_string(i);
    }
    scene.actuated = std::vector<std::string>{"joint_1"};
  }
  static Mechanism make(int cranks) {
    RobotBuilder builder(1);
    const Vector3l z = Vector3l::UnitZ();
    builder.add(JointType::kContinuous, 0, z, Matrix3l::Identity(), Vector3l::Zero());
    builder.add(JointType::kContinuous, 1, z, Matrix3l::Identity(), Vector3l(kCrank, 0, 0));
    for (int i = 1; i < cranks; ++i) {
      builder.add(JointType::kContinuous, 0, z, Matrix3l::Identity(), Vector3l(i, 0, 0));
    }
    return builder.build();
  }
  Eigen::VectorXd closed(double angle) const {
    Eigen::VectorXd q =
        Eigen::VectorXd::Constant(static_cast<Eigen::Index>(mechanism.coordinates().size()), angle);
    q[1] = -angle;
    return q;
  }

  Mechanism mechanism;
  Scene scene;
};

/// Types of closures and their numbers of conditions.
constexpr std::array<std::pair<ClosureType, int>, 8> kConditionsOfTypes{
    {{ClosureType::kFixed, 6},
     {ClosureType::kRevolute, 5},
     {ClosureType::kPrismatic, 5},
     {ClosureType::kCylindrical, 4},
     {ClosureType::kUniversal, 4},
     {ClosureType::kSpherical, 3},
     {ClosureType::kPlanar, 3},
     {ClosureType::kDistance, 1}}};

/// A loop in space of the type, of joints in general position, closed at `closed`.
struct SpatialLoop {
  SpatialLoop(ClosureType type, int conditions, unsigned seed) : builder(seed) {
    const int joints = conditions + 1;
    closed.resize(joints);
    for (int i = 0; i < joints; ++i) {
      const Vector3l axis = builder.direction(), place = builder.vector(0.5);
      const Matrix3l R = builder.rotation();
      builder.add(JointType::kContinuous, i, axis, R, place);
      closed[i] = builder.uniform(-3, 3);
    }
    mechanism = std::make_unique<Mechanism>(builder.build());
    Eigen::Vector3d o = Eigen::Vector3d::Zero();
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    for (int i = 0; i < joints; ++i) {
      const Joint& joint = mechanism->joint(i);
      o += R * joint.p_PoKo_P.cast<double>();
      R = R * joint.R_PK.cast<double>() *
          Eigen::AngleAxisd(closed[i], joint.axis_K.cast<double>()).toRotationMatrix();
    }
    const LinkFrame tip =
        frameAt(mechanism->links().back().name, builder.vector(0.5).cast<double>());
    LinkFrame base = frameAt("link_0", o + R * tip.xyz);
    base.rpy << std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)), std::atan2(R(1, 0), R(0, 0));
    if (type == ClosureType::kDistance) base.xyz += Eigen::Vector3d(0.3, -0.2, 0.4);
    scene.closures = {closureOf(type, base, tip)};
    if (type == ClosureType::kDistance) {
      scene.closures[0].length = (base.xyz - (o + R * tip.xyz)).norm();
    }
    scene.actuated = std::vector<std::string>{mechanism->coordinateNames()[0]};
  }

  RobotBuilder builder;
  std::unique_ptr<Mechanism> mechanism;
  Scene scene;
  Eigen::VectorXd closed;
};

}  // namespace virtual_work_dynamics
