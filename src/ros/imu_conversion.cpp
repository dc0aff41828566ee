#include "ros/imu_conversion.h"

#include <cmath>
#include <vector>

#include "base/nearest_name.h"
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
  if (!found_ || message.header.frame_id != frame_) {
    if (auto rejection = findFrame(message.header.frame_id)) return rejection;
  }
  sample.angular_velocity = R_0F_ * rate;
  sample.specific_force = R_0F_ * force;
  sample.at = p_0oFo_0_;
  return std::nullopt;
}

std::optional<Rejection> ImuConversion::findFrame(const std::string& id) {
  const bool prefixed = id.compare(0, frame_prefix_.size(), frame_prefix_) == 0;
  int link = prefixed ? mechanism_.linkIndex(id.substr(frame_prefix_.size())) : -1;
  if (link < 0) {
    std::vector<std::string> names;
    for (const Link& known : mechanism_.links()) names.push_back(known.name);
    return Rejection{DropReason::kUnknownFrame,
                     "its frame " + inQuotes(id) + " is not " +
                         (frame_prefix_.empty() ? "" : inQuotes(frame_prefix_) + " and ") +
                         "a link of robot " + inQuotes(mechanism_.name()) + nameHelp(id, names)};
  }
  Matrix3l R_LF = Matrix3l::Identity();
  Vector3l p_LoFo_L = Vector3l::Zero();
  while (mechanism_.link(link).parent_joint >= 0) {
    const Joint& joint = mechanism_.joint(mechanism_.link(link).parent_joint);
    if (joint.type != JointType::kFixed) {
      return Rejection{DropReason::kUnknownFrame, "its frame " + inQuotes(id) +
                                                      " moves against the root link, by joint " +
                                                      inQuotes(joint.name)};
    }
    p_LoFo_L = joint.p_PoKo_P + joint.R_PK * p_LoFo_L;
    R_LF = joint.R_PK * R_LF;
    link = joint.parent_link;
  }
  R_0F_ = R_LF.cast<double>();
  p_0oFo_0_ = p_LoFo_L.cast<double>();
  frame_ = id;
  found_ = true;
  return std::nullopt;
}

}  // namespace virtual_work_dynamics
