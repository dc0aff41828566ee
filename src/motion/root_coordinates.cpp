#include "motion/root_coordinates.h"

#include <algorithm>
#include <cmath>

#include "base/cross_matrix.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

Quaterniond cycled(const Quaterniond& orientation) {
  return orientation * Quaterniond(0.5, 0.5, 0.5, 0.5);
}
Quaterniond uncycled(const Quaterniond& orientation) {
  return orientation * Quaterniond(0.5, -0.5, -0.5, -0.5);
}

// The product of a vector and a quaternion (x, y, z, w).
Vector4d product(const Vector3d& vector, const Vector4d& q) {
  return (Quaterniond(0, vector.x(), vector.y(), vector.z()) * Quaterniond(q)).coeffs();
}

// The vector of the product of a quaternion and the conjugate of another one.
Vector3d vectorOfRatio(const Vector4d& a, const Vector4d& b) {
  return (Quaterniond(a) * Quaterniond(b).conjugate()).vec();
}

}  // namespace

RootCoordinates coordinatesOf(const RootMotion& motion) {
  const Vector4d q = cycled(motion.orientation).coeffs();
  const Vector4d qd = product(motion.angular_velocity, q) / 2;
  const Vector4d qdd =
      (product(motion.angular_acceleration, q) + product(motion.angular_velocity, qd)) / 2;
  RootCoordinates coordinates;
  coordinates.col(0) << motion.position, q;
  coordinates.col(1) << motion.velocity, qd;
  coordinates.col(2) << motion.acceleration, qdd;
  return coordinates;
}

RootMotion rootMotionOf(const RootCoordinates& coordinates) {
  const double length = coordinates.col(0).tail<4>().norm();
  const Vector4d r = coordinates.col(0).tail<4>() / length;
  const Vector4d qd = coordinates.col(1).tail<4>() / length;
  const Vector4d qdd = coordinates.col(2).tail<4>() / length;
  RootMotion motion;
  motion.position = coordinates.col(0).head<3>();
  motion.velocity = coordinates.col(1).head<3>();
  motion.acceleration = coordinates.col(2).head<3>();
  motion.orientation = uncycled(Quaterniond(r));
  motion.angular_velocity = 2 * vectorOfRatio(qd, r);
  // The length's own rate is r.q'/|q|; r'' = (q'' - 2 |q|' r' - |q|'' r) / |q|, of which the last
  // term turns nothing.
  motion.angular_acceleration = 2 * vectorOfRatio(qdd, r) - 2 * r.dot(qd) * motion.angular_velocity;
  return motion;
}

TurnCovariance turnCovarianceOf(const RootMotion& motion, const RootCoordinateCovariances& each) {
  // With q + dq = q + x q / 2 for a small turn x about inertial axes, and so the derivatives: the
  // numbers x, one vector a level, have covariances of 4 / 3 of the sum, alike about all axes.
  Matrix3d level = Matrix3d::Zero();
  for (std::size_t i = 3; i < each.size(); ++i) level += each[i];
  level *= 4.0 / 3;
  const Vector3d& w = motion.angular_velocity;
  TurnCovariance by = TurnCovariance::Identity();  // of the motion by x
  by.block<3, 3>(0, 0) = motion.orientation.toRotationMatrix().transpose();
  by.block<3, 3>(3, 0) = -crossMatrix(w) / 2;
  by.block<3, 3>(6, 0) = -crossMatrix(motion.angular_acceleration) / 2 - w * w.transpose() / 2;
  by.block<3, 3>(6, 0).diagonal().array() += w.squaredNorm() / 4;
  TurnCovariance x;
  for (Eigen::Index a = 0; a < 3; ++a) {
    for (Eigen::Index b = 0; b < 3; ++b)
      x.block<3, 3>(3 * a, 3 * b) = level(a, b) * Matrix3d::Identity();
  }
  return by * x * by.transpose();
}

StreamQuality turnQuality(const std::array<StreamQuality, 4>& quaternion) {
  StreamQuality turn = quaternion.front();
  double positions = 0, velocities = 0;
  for (const StreamQuality& number : quaternion) {
    positions += number.position_noise * number.position_noise;
    velocities += number.velocity_noise * number.velocity_noise;
    if (number.velocity_noise < 0) turn.velocity_noise = -1;
    if (number.velocity_ratio != 1) turn.velocity_ratio = number.velocity_ratio;
    turn.bandwidth = std::max(turn.bandwidth, number.bandwidth);
    turn.jumps = std::max(turn.jumps, number.jumps);
    turn.left_out = std::max(turn.left_out, number.left_out);
  }
  turn.position_noise = std::sqrt(positions * 4 / 3);
  if (turn.velocity_noise >= 0) turn.velocity_noise = std::sqrt(velocities * 4 / 3);
  return turn;
}

RootCovariance rootCovarianceOf(const RootMotion& motion, const RootCoordinateCovariances& each) {
  RootCovariance covariance = RootCovariance::Zero();
  covariance.topLeftCorner<9, 9>() = turnCovarianceOf(motion, each);
  for (Eigen::Index i = 0; i < 3; ++i)
    covariance(9 + i, 9 + i) = each[static_cast<std::size_t>(i)](2, 2);
  return covariance;
}

TurnCovariance inBodyAxes(const FreeTurn& turn, const TurnCovariance& covariance) {
  // A vector in inertial axes turns with the body's error the other way.
  const Matrix3d to_body = turn.orientation.toRotationMatrix().transpose();
  TurnCovariance by = TurnCovariance::Zero();
  by.block<3, 3>(0, 0).setIdentity();
  by.block<3, 3>(3, 0) = crossMatrix(turn.angular_velocity);
  by.block<3, 3>(6, 0) = crossMatrix(turn.angular_acceleration);
  by.block<3, 3>(3, 3) = by.block<3, 3>(6, 6) = to_body;
  return by * covariance * by.transpose();
}

void chooseSign(const RootCoordinates& before, RootCoordinates& coordinates) {
  if (before.col(0).tail<4>().dot(coordinates.col(0).tail<4>()) < 0)
    coordinates.bottomRows<4>() *= -1;
}

}  // namespace virtual_work_dynamics
