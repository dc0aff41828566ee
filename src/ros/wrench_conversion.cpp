#include "ros/wrench_conversion.h"

#include <cmath>
#include <utility>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {
namespace {

struct Component {
  const char* name;
  double value;
};

// Copies the values; returns the first one that is not finite.
std::optional<Component> copyFinite(const geometry_msgs::Wrench& from, Wrench& to) {
  to.force << from.force.x, from.force.y, from.force.z;
  to.torque << from.torque.x, from.torque.y, from.torque.z;
  constexpr const char* kNames[] = {"force.x",  "force.y",  "force.z",
                                    "torque.x", "torque.y", "torque.z"};
  for (int i = 0; i < 6; ++i) {
    const double value = i < 3 ? to.force[i] : to.torque[i - 3];
    if (!std::isfinite(value)) return Component{kNames[i], value};
  }
  return std::nullopt;
}

std::vector<std::string> linkNames(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (const Link& link : mechanism.links()) names.push_back(link.name);
  return names;
}

}  // namespace

WrenchConversion::WrenchConversion(const Mechanism& mechanism, std::string frame_prefix,
                                   LiveWrenches& wrenches)
    : mechanism_(mechanism),
      frame_prefix_(std::move(frame_prefix)),
      wrenches_(wrenches),
      frames_(wrenches.size()) {}

std::optional<Rejection> WrenchConversion::take(std::size_t i,
                                                const geometry_msgs::WrenchStamped& message,
                                                const MeasuringFrame* foreign) {
  if (message.header.stamp.isZero()) return Rejection{DropReason::kZeroStamp, "its stamp is zero"};
  MeasuredWrench wrench;
  if (const auto wrong = copyFinite(message.wrench, wrench.value)) {
    return Rejection{DropReason::kNotFinite,
                     std::string("its ") + wrong->name + " is " + numberText(wrong->value)};
  }
  const Frame& frame = frameOf(i, message.header.frame_id);
  if (frame.link < 0 && !foreign) {
    return Rejection{DropReason::kUnknownFrame,
                     "its frame " + inQuotes(frame.id) + " is not " +
                         (frame_prefix_.empty() ? "" : inQuotes(frame_prefix_) + " and ") +
                         "a link of robot " + inQuotes(mechanism_.name()) +
                         nameHelp(frame.id, linkNames(mechanism_))};
  }
  wrench.frame = foreign ? foreign->link : frame.link;
  if (foreign) {
    wrench.value.force = (foreign->R * wrench.value.force).eval();
    wrench.value.torque = (foreign->R * wrench.value.torque).eval();
    wrench.at = foreign->origin;
  }
  wrench.stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
  switch (wrenches_.push(i, wrench)) {
    case WrenchHistory::Verdict::kTaken:
      return std::nullopt;
    case WrenchHistory::Verdict::kEqualStamp:
      return Rejection{DropReason::kEqualStamp,
                       "its stamp " + stampText(wrench.stamp_ns) + " was received before"};
    case WrenchHistory::Verdict::kTooLate:
      break;
  }
  return Rejection{DropReason::kTooLate,
                   "its stamp " + stampText(wrench.stamp_ns) + " is behind one received before"};
}

const WrenchConversion::Frame& WrenchConversion::frameOf(std::size_t i, const std::string& id) {
  Frame& frame = frames_[i];
  if (frame.id == id) return frame;
  frame.id = id;
  const bool prefixed = id.compare(0, frame_prefix_.size(), frame_prefix_) == 0;
  frame.link = prefixed ? mechanism_.linkIndex(id.substr(frame_prefix_.size())) : -1;
  return frame;
}

}  // namespace virtual_work_dynamics
