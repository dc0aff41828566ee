#include "ros/pose_reading.h"

#include <limits>

#include "motion/orientation_length.h"

namespace virtual_work_dynamics {

std::optional<Rejection> PoseReading::readOrientation(const geometry_msgs::Quaternion& message,
                                                      const std::string& where,
                                                      Eigen::Quaterniond& orientation) {
  orientation = Eigen::Quaterniond(message.w, message.x, message.y, message.z);
  for (int i = 0; i < 4; ++i) {
    if (std::isfinite(orientation.coeffs()[i])) continue;
    return Rejection{DropReason::kNotFinite, "its " + where + "." + "xyzw"[i] + " is " +
                                                 numberText(orientation.coeffs()[i])};
  }
  const double length = orientation.norm();
  const double off = std::abs(length - 1);
  if (!(off <= kOrientationOff)) {
    return Rejection{DropReason::kOrientation,
                     "its " + where + " has the length " + numberText(length) + ", not 1"};
  }
  if (off > kOrientationDoubt && !length_doubted_) {
    doubt(length_doubted_, "the quaternion " + where + " has the length " + numberText(length) +
                               "; it and those like it are scaled to 1");
  }
  orientation.normalize();
  return std::nullopt;
}

std::optional<Rejection> PoseReading::readTransform(const geometry_msgs::Transform& from,
                                                    const std::string& where,
                                                    Eigen::Vector3d& position,
                                                    Eigen::Quaterniond& orientation) {
  if (auto rejection = readVector(from.translation, where + "translation", position))
    return rejection;
  return readOrientation(from.rotation, where + "rotation", orientation);
}

// Drivers fill what they do not measure with NaN.
void PoseReading::takeTwist(const geometry_msgs::Twist& message, Eigen::Vector3d& linear,
                            Eigen::Vector3d& angular) {
  twist_left_out_ = false;
  const auto take = [&](const geometry_msgs::Vector3& given, const char* name,
                        Eigen::Vector3d& part) {
    if (copyVector(given, part)) return;
    twist_left_out_ = true;
    // The text is made once only, as it allocates.
    if (!twist_doubted_) {
      doubt(twist_doubted_, readVector(given, name, part)->text +
                                ": poses count without rates that are not finite");
    }
    part.setConstant(std::numeric_limits<double>::quiet_NaN());
  };
  take(message.linear, "twist.linear", linear);
  take(message.angular, "twist.angular", angular);
}

void PoseReading::doubt(bool& doubted, const std::string& text) {
  doubted = true;
  doubt_ += (doubt_.empty() ? "" : "; ") + text;
}

std::string PoseReading::takeDoubt() {
  std::string doubt;
  doubt.swap(doubt_);
  return doubt;
}

}  // namespace virtual_work_dynamics
