#include "replay/replayed_wrenches.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "base/printable.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {
namespace {

// As of WrenchInputs.
constexpr std::int64_t kBegins = 2'000'000'000;  // ns
constexpr double kLongest = 1e9;                 // s, for ever
constexpr std::size_t kMostWaiting = 4096;

std::string posedIn(const RootSettings& root) {
  const bool posed = root.source != RootSource::kNone && root.source != RootSource::kImu;
  return posed ? root.inertial_frame : "";
}

std::int64_t stampOf(const geometry_msgs::WrenchStamped& message) {
  return static_cast<std::int64_t>(message.header.stamp.toNSec());
}

}  // namespace

ReplayedWrenches::ReplayedWrenches(const Mechanism& mechanism,
                                   const InverseDynamicsParameters& parameters,
                                   LiveWrenches& wrenches, std::size_t count, Drop drop)
    : root_(parameters.root),
      timeout_(static_cast<std::int64_t>(std::min(parameters.wrench_timeout, kLongest) * 1e9)),
      count_(count),
      drop_(std::move(drop)),
      conversion_(mechanism, parameters.frame_prefix, wrenches),
      frames_(mechanism, parameters.frame_prefix, posedIn(parameters.root),
              parameters.estimator.max_gap) {}

void ReplayedWrenches::take(std::size_t i, std::size_t number,
                            const geometry_msgs::WrenchStamped& message, std::int64_t receipt) {
  if (const auto rejection = receive(i, number, message, receipt)) drop_(i, number, *rejection);
}

std::optional<Rejection> ReplayedWrenches::receive(std::size_t i, std::size_t number,
                                                   const geometry_msgs::WrenchStamped& message,
                                                   std::int64_t receipt) {
  const std::string& id = message.header.frame_id;
  const bool foreign =
      !id.empty() && !message.header.stamp.isZero() && !conversion_.knowsFrame(i, message);
  if (foreign && root_.source == RootSource::kImu && id == root_.inertial_frame) {
    return Rejection{DropReason::kUnknownFrame,
                     "its frame " + inQuotes(id) +
                         " is the inertial one, and an IMU does not tell where the root link is in "
                         "it"};
  }
  if (!foreign && !waits(i)) return conversion_.take(i, message);
  if (!foreign_since_) foreign_since_ = receipt;
  if (waiting_.size() == kMostWaiting) waiting_.front().until = 0;
  waiting_.push_back({i, number, message, std::max(receipt + timeout_, *foreign_since_ + kBegins)});
  takeWaiting(receipt);
  return std::nullopt;
}

void ReplayedWrenches::takeFrames(const tf2_msgs::TFMessage& message, bool is_static,
                                  std::int64_t receipt) {
  frames_.take(message, is_static);
  takeWaiting(receipt);
}

void ReplayedWrenches::waitUntil(std::int64_t receipt) {
  if (!waiting_.empty() && receipt >= waiting_.front().until) takeWaiting(receipt);
}

void ReplayedWrenches::finish() {
  takeWaiting(std::numeric_limits<std::int64_t>::max());
}

// Whether messages of a wrench wait, so that others have to queue up behind them.
bool ReplayedWrenches::waits(std::size_t i) const {
  return std::any_of(waiting_.begin(), waiting_.end(),
                     [i](const Waiting& waiting) { return waiting.i == i; });
}

void ReplayedWrenches::takeWaiting(std::int64_t now) {
  std::deque<Waiting> left;
  std::vector<bool> blocked(count_, false);
  std::swap(left, waiting_);
  for (Waiting& each : left) {
    const geometry_msgs::WrenchStamped& message = each.message;
    const bool is_link = conversion_.knowsFrame(each.i, message);
    std::optional<MeasuringFrame> frame;
    if (!is_link && !blocked[each.i]) {
      frame = frames_.find(message.header.frame_id, stampOf(message));
    }
    if (now < each.until && (blocked[each.i] || (!frame && !is_link))) {
      blocked[each.i] = true;
      waiting_.push_back(std::move(each));
      continue;
    }
    auto rejection = conversion_.take(each.i, message, frame ? &*frame : nullptr);
    if (!rejection) continue;
    if (rejection->reason == DropReason::kUnknownFrame) {
      rejection->text +=
          ", and tf tells of no way from it to one at stamp " + stampText(stampOf(message));
    }
    drop_(each.i, each.number, *rejection);
  }
}

}  // namespace virtual_work_dynamics
