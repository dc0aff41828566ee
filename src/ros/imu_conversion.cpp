#include "ros/imu_conversion.h"

#include <cmath>

#include "base/number_text.h"
#include "base/printable.h"
#include "motion/largest_motion.h"

namespace virtual_work_dynamics {
namespace {

// By their covariance, messages say that they do not have a quantity.
constexpr double kNotGiven = -1;

std::optional<Rejection> read(const geometry_msgs::Vector3& from, double covariance,
                              const std::string& what, Eigen::Vector3d& vector) {
  if (covariance == kNotGiven) {
    return Rejection{DropReason::kNotFinite, "by its covariance it does not have " + what};
  }
  vector << from.x, from.y, from.z;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(vector[i]) <= kLargestMotion) continue;
    return Rejection{DropReason::kNotFinite,
                     "its " + what + "." + "xyz"[i] + " is " + numberText(vector[i])};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Rejection> ImuConversion::convert(const sensor_msgs::Imu& message,
                                                ImuSample& sample) {
  if (message.header.stamp.isZero()) return Rejection{DropReason::kZeroStamp, "its stamp is zero"};
  sample.stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
  Eigen::Vector3d rate, force;
  if (auto rejection = read(message.angular_velocity, message.angular_velocity_covariance[0],
                            "angular_velocity", rate))
    return rejection;
  if (auto rejection = read(message.linear_acceleration, message.linear_acceleration_covariance[0],
                            "linear_acceleration", force))
    return rejection;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  if (auto rejection = readOrientation(message, orientation)) return rejection;
  const std::string& id = message.header.frame_id;
  if (!found_ || id != frame_) {
    int link = 0;
    FixedFrame placed;
    if (auto rejection = findCarryingLink(mechanism_, frame_prefix_, id, link, placed))
      return rejection;
    // Two units by turns would tell of nothing, as each begins anew.
    if (found_ && static_cast<double>(sample.stamp_ns - stamp_ns_) / 1e9 <= max_gap_) {
      return Rejection{DropReason::kUnknownFrame, "its frame " + inQuotes(id) +
                                                      " is another one than " + inQuotes(frame_) +
                                                      " of the unit that is listened to"};
    }
    link_ = link;
    placed_ = placed;
    frame_ = id;
    found_ = true;
  }
  stamp_ns_ = sample.stamp_ns;
  sample.angular_velocity = placed_.R * rate;
  sample.specific_force = placed_.R * force;
  sample.link = link_;
  sample.at = placed_.origin;
  if (oriented_) sample.orientation = orientation * Eigen::Quaterniond(placed_.R).conjugate();
  return std::nullopt;
}

std::optional<Rejection> ImuConversion::readOrientation(const sensor_msgs::Imu& message,
                                                        Eigen::Quaterniond& orientation) {
  if (!oriented_) return std::nullopt;
  if (message.orientation_covariance[0] == kNotGiven) {
    return Rejection{DropReason::kOrientation,
                     "by its covariance it does not have orientation, without which there are no "
                     "results in inertial axes"};
  }
  return orientations_.readOrientation(message.orientation, "orientation", orientation);
}

}  // namespace virtual_work_dynamics
