#pragma once

#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <string>

#include "base/number_text.h"
#include "motion/largest_motion.h"
#include "ros/rejection.h"

namespace virtual_work_dynamics {

/// Copies three numbers. Returns whether all are finite and no larger than any robot's.
template <typename Message>
bool copyVector(const Message& message, Eigen::Vector3d& vector) {
  vector << message.x, message.y, message.z;
  return std::abs(message.x) <= kLargestMotion && std::abs(message.y) <= kLargestMotion &&
         std::abs(message.z) <= kLargestMotion;
}

/// Copies three numbers; refuses those that are not finite, or are beyond any robot's.
template <typename Message>
std::optional<Rejection> readVector(const Message& message, const std::string& what,
                                    Eigen::Vector3d& vector) {
  if (copyVector(message, vector)) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(vector[i]) <= kLargestMotion) continue;
    return Rejection{DropReason::kNotFinite,
                     "its " + what + "." + "xyz"[i] + " is " + numberText(vector[i])};
  }
  return std::nullopt;
}

/// Checks the poses and twists of messages. Quaternions whose length is within 1e-3 of 1 are scaled
/// to 1, and of twists that are not finite the linear or the angular part is left out: the pose
/// counts without it. Each function allocates only for a rejection or a doubt, and returns why the
/// message is to be dropped, or nothing.
class PoseReading {
 public:
  std::optional<Rejection> readTransform(const geometry_msgs::Transform& from,
                                         const std::string& where, Eigen::Vector3d& position,
                                         Eigen::Quaterniond& orientation);
  std::optional<Rejection> readOrientation(const geometry_msgs::Quaternion& message,
                                           const std::string& where,
                                           Eigen::Quaterniond& orientation);
  /// Parts that are left out are NaN.
  void takeTwist(const geometry_msgs::Twist& message, Eigen::Vector3d& linear,
                 Eigen::Vector3d& angular);

  /// Text about the first quaternion whose length is farther from 1 than single precision explains,
  /// or about the first twist of which a part is left out; empty before there is one, and once it
  /// has been taken.
  std::string takeDoubt();
  /// Whether a part of the latest twist was left out.
  bool twistLeftOut() const { return twist_left_out_; }
  /// A message begins.
  void begin() { twist_left_out_ = false; }

 private:
  void doubt(bool& doubted, const std::string& text);

  bool length_doubted_ = false, twist_doubted_ = false, twist_left_out_ = false;
  std::string doubt_;
};

}  // namespace virtual_work_dynamics
