#include "ros/free_joint_conversion.h"

#include <algorithm>
#include <cstdint>

#include "base/printable.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {
namespace {

// The joint of a name; their number: there is none.
std::size_t freeJointNamed(const Mechanism& mechanism, const std::string& name) {
  std::size_t i = 0;
  while (i < mechanism.orientations() && mechanism.freeJoint(i).name != name) ++i;
  return i;
}

Rejection wrongCount(std::size_t values, const char* what, std::size_t names) {
  return {DropReason::kArrayLength, "it has " + std::to_string(values) + " " + what + " for " +
                                        std::to_string(names) + " names"};
}

}  // namespace

bool namesFreeJoint(const Mechanism& mechanism, const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return freeJointNamed(mechanism, name) < mechanism.orientations();
  });
}

std::optional<Rejection> FreeJointConversion::convert(
    const sensor_msgs::MultiDOFJointState& message, std::vector<FreeJointSample>& samples) {
  samples.clear();
  const std::size_t names = message.joint_names.size();
  if (message.transforms.size() != names)
    return wrongCount(message.transforms.size(), "transforms", names);
  const bool twists = !message.twist.empty();
  if (twists && message.twist.size() != names)
    return wrongCount(message.twist.size(), "twists", names);
  for (std::size_t column = 0; column < names; ++column) {
    const std::string& name = message.joint_names[column];
    FreeJointSample sample;
    sample.orientation = freeJointNamed(mechanism_, name);
    if (sample.orientation == mechanism_.orientations()) continue;
    const bool twice = std::any_of(samples.begin(), samples.end(), [&](const auto& other) {
      return other.orientation == sample.orientation;
    });
    if (twice) return Rejection{DropReason::kJointTwice, "it names " + inQuotes(name) + " twice"};
    sample.turn.stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
    auto wrong = poses_.readTransform(message.transforms[column], "", sample.position,
                                      sample.turn.orientation);
    if (wrong) {
      wrong->text = "of joint " + inQuotes(name) + ", " + wrong->text;
      return wrong;
    }
    sample.velocity = sample.turn.angular_velocity;  // not given
    if (twists)
      poses_.takeTwist(message.twist[column], sample.velocity, sample.turn.angular_velocity);
    samples.push_back(sample);
  }
  if (samples.empty()) {
    return Rejection{DropReason::kNoKnownJoint,
                     "it names no joint of robot " + inQuotes(mechanism_.name()) +
                         " that turns freely" +
                         (names == 0 ? "" : ": " + shortList(message.joint_names))};
  }
  if (message.header.stamp.isZero()) return Rejection{DropReason::kZeroStamp, "its stamp is zero"};
  return std::nullopt;
}

}  // namespace virtual_work_dynamics
