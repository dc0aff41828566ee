#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "exact_derivatives.h"
#include "tested_build.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {

using Vector2l = Eigen::Matrix<long double, 2, 1>;
using VectorXl = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

constexpr long double kPi = 3.14159265358979323846L;

/// An example of the package with closed loops: urdf/<name>.urdf with config/<name>_scene.yaml.
struct LoopExample {
  Mechanism mechanism;
  Scene scene;

  explicit LoopExample(const std::string& name)
      : mechanism(readUrdfFile(std::string(kSourceFolder) + "/urdf/" + name + ".urdf")),
        scene(readSceneFile(std::string(kSourceFolder) + "/config/" + name + "_scene.yaml")) {}
};

/// Positions of joints by name.
using Positions = std::map<std::string, long double>;

/// Positions, velocities and accelerations of all joints of a mechanism from `positions`, a
/// function of time that closes the loops.
template <typename F>
Motion motionAt(const Mechanism& mechanism, const F& positions, long double t) {
  const auto in_order = [&](long double time) {
    const Positions at = positions(time);
    VectorXl q(static_cast<Eigen::Index>(at.size()));
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = at.at(mechanism.coordinateNames().at(static_cast<std::size_t>(i)));
    }
    return q;
  };
  const auto exact = withDerivatives(in_order, t);
  Motion motion;
  motion.q = exact.value.template cast<double>();
  motion.qd = exact.rate.template cast<double>();
  motion.qdd = exact.acceleration.template cast<double>();
  return motion;
}

inline Vector2l along(long double angle) {
  return {std::cos(angle), std::sin(angle)};
}
inline long double angleOf(const Vector2l& v) {
  return std::atan2(v.y(), v.x());
}

/// The third corner of a triangle over a, b with sides to_a, to_b; it is on the left of a -> b for
/// side 1.
inline Vector2l corner(const Vector2l& a, const Vector2l& b, long double to_a, long double to_b,
                       int side) {
  const Vector2l d = b - a;
  const long double x = (to_a * to_a - to_b * to_b + d.squaredNorm()) / (2 * d.norm());
  const long double y = side * std::sqrt(to_a * to_a - x * x);
  return a + (x * d + y * Vector2l(-d.y(), d.x())) / d.norm();
}

// Motions of the examples in closed form, with the lengths of the descriptions.

inline long double crankAngle(long double t) {
  return 0.7L + 2 * t + 0.4L * std::sin(3 * t);
}

inline Positions fourBarAt(long double t) {
  const long double crank = crankAngle(t);
  const Vector2l a = 0.12L * along(crank), c{0.40L, 0};
  const Vector2l pin = corner(a, c, 0.36L, 0.28L, 1);
  return {{"crank_joint", crank},
          {"coupler_joint", angleOf(pin - a) - crank},
          {"rocker_joint", angleOf(pin - c)}};
}

inline Positions sliderCrankAt(long double t) {
  const long double crank = crankAngle(t);
  const long double rod = -std::asin(0.10L / 0.30L * std::sin(crank));
  return {{"crank_joint", crank},
          {"rod_joint", rod - crank},
          {"slider_joint", 0.10L * std::cos(crank) + 0.30L * std::cos(rod)}};
}

/// Position of the centre and angle of the 3-RRR manipulator's platform.
inline Vector3l planarPose(long double t) {
  return {0.05L * std::sin(2 * t), 0.04L * std::cos(3 * t), 0.3L * std::sin(2.5L * t)};
}

inline Positions planar3rrrAt(long double t) {
  const Vector3l pose = planarPose(t);
  Positions q;
  for (int i = 0; i < 3; ++i) {
    const long double place = kPi / 2 + i * 2 * kPi / 3;
    const Vector2l motor = 0.35L * along(place);
    const Vector2l vertex = pose.head<2>() + 0.10L * along(place + pose.z());
    const Vector2l elbow = corner(motor, vertex, 0.20L, 0.20L, 1);
    const std::string n = std::to_string(i + 1);
    // The vector is turned into the motor's own direction, so that no angle jumps.
    const long double arm =
        place + kPi + angleOf(Eigen::Rotation2D<long double>(-place - kPi) * (elbow - motor));
    const long double bend = angleOf(Eigen::Rotation2D<long double>(-arm) * (vertex - elbow));
    q["motor_" + n] = arm;
    q["elbow_" + n] = bend;
    if (i == 0) q["wrist_1"] = pose.z() - arm - bend;
  }
  return q;
}

struct SpatialPose {
  Vector3l p;
  Matrix3l R;
};

/// The pose of the Stewart-Gough platform.
inline SpatialPose platformPose(long double t) {
  using Turn = Eigen::AngleAxis<long double>;
  const Vector3l p{0.08L * std::sin(2 * t), 0.06L * std::cos(1.5L * t),
                   0.82L + 0.05L * std::sin(3 * t)};
  const Matrix3l R = (Turn(0.15L * std::cos(2 * t), Vector3l::UnitX()) *
                      Turn(0.2L * std::sin(2.5L * t), Vector3l::UnitY()) *
                      Turn(0.3L * std::sin(t), Vector3l::UnitZ()))
                         .toRotationMatrix();
  return {p, R};
}

/// A point of the Stewart-Gough platform in its base or platform, rounded as in the description.
inline Vector3l circlePoint(long double radius, int degrees) {
  const Vector2l point = radius * along(degrees * kPi / 180);
  return {std::round(point.x() * 1e6L) / 1e6L, std::round(point.y() * 1e6L) / 1e6L, 0};
}
inline Vector3l basePoint(int leg) {
  return circlePoint(0.6L, std::array<int, 6>{10, 110, 130, 230, 250, 350}.at(leg));
}
inline Vector3l platformPoint(int leg) {
  return circlePoint(0.4L, std::array<int, 6>{50, 70, 170, 190, 290, 310}.at(leg));
}

inline Positions stewartGoughAt(long double t) {
  using Turn = Eigen::AngleAxis<long double>;
  const SpatialPose pose = platformPose(t);
  Positions q;
  for (int i = 0; i < 6; ++i) {
    const Vector3l leg = pose.p + pose.R * platformPoint(i) - basePoint(i);
    const long double x = std::atan2(-leg.y(), leg.z()), y = std::asin(leg.x() / leg.norm());
    const std::string name = "leg_" + std::to_string(i + 1);
    q[name] = leg.norm();
    q[name + "_x"] = x;
    q[name + "_y"] = y;
    if (i > 0) continue;
    const Matrix3l R =
        (Turn(x, Vector3l::UnitX()) * Turn(y, Vector3l::UnitY())).toRotationMatrix().transpose() *
        pose.R;
    q["ball_1_x"] = std::atan2(-R(1, 2), R(2, 2));
    q["ball_1_y"] = std::asin(R(0, 2));
    q["ball_1_z"] = std::atan2(-R(0, 1), R(0, 0));
  }
  return q;
}

inline Positions parallelogramAt(long double t) {
  const long double angle = 0.6L * std::sin(2 * t) - 0.2L;
  return {{"arm_joint_1", angle}, {"arm_joint_2", angle}, {"arm_joint_3", angle},
          {"ball_3_x", 0},        {"ball_3_y", -angle},   {"ball_3_z", 0}};
}

/// Positions of the squeezing mechanism with the published parameters and its crank at
/// crankAngle(t).
inline Positions andrewsAt(long double t) {
  const long double beta = crankAngle(t);
  const Vector2l f = 0.007L * along(beta), a{-0.06934L, -0.00227L}, b{-0.03635L, 0.03273L};
  const Vector2l e = corner(b, f, 0.035L, 0.028L, -1);
  const Vector2l g = corner(a, e, 0.04L, 0.02L, 1), h = corner(a, e, 0.04L, 0.02L, -1);
  const long double gamma = angleOf(e - b) + kPi / 2, delta = angleOf(g - a);
  const long double epsilon = angleOf(h - a) + kPi / 2;
  return {{"beta", beta},
          {"theta", angleOf(Eigen::Rotation2D<long double>(-beta) * (f - e))},
          {"gamma", gamma},
          {"delta", delta},
          {"phi", angleOf(Eigen::Rotation2D<long double>(-delta) * (e - g)) + kPi / 2},
          {"epsilon", epsilon},
          {"omega", angleOf(Eigen::Rotation2D<long double>(-epsilon) * (e - h))}};
}

}  // namespace virtual_work_dynamics
