#include "motion/root_coordinates.h"

namespace virtual_work_dynamics {
namespace {

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

void chooseSign(const RootCoordinates& before, RootCoordinates& coordinates) {
  if (before.col(0).tail<4>().dot(coordinates.col(0).tail<4>()) < 0)
    coordinates.bottomRows<4>() *= -1;
}

}  // namespace virtual_work_dynamics
