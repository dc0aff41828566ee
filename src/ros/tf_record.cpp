#include "ros/tf_record.h"

#include <ros/time.h>

#include <limits>

namespace virtual_work_dynamics {
namespace {

// By which tf2 is to name the publishers in its own messages.
constexpr char kAuthority[] = "tf";

// How long tf2 knows what was, and the last stamp to which it can add that.
constexpr std::int64_t kKnown = 10'000'000'000;  // ns
constexpr std::int64_t kLast =
    std::numeric_limits<std::uint32_t>::max() * std::int64_t{1'000'000'000} - kKnown;

// Filling the buffer anew may cost, for each transform taken, so many of those that it has: frames
// that go back all the time, as two clocks tell of them, must not take all the time.
constexpr std::size_t kShare = 8;

}  // namespace

void TfRecord::take(const geometry_msgs::TransformStamped& transform, bool is_static) {
  // What tf2 would refuse with a line of its own for each message.
  const std::string& parent = transform.header.frame_id;
  const std::string& child = transform.child_frame_id;
  if (parent.empty() || child.empty() || parent == child) return;
  if (is_static) {
    buffer_.setTransform(transform, kAuthority, true);
  } else if (static_cast<std::int64_t>(transform.header.stamp.toNSec()) < kLast) {
    keep(transform);
  }
}

void TfRecord::keep(const geometry_msgs::TransformStamped& transform) {
  Frame& frame = frames_[transform.child_frame_id];
  auto& known = frame.known;
  const auto stamp_ns = static_cast<std::int64_t>(transform.header.stamp.toNSec());
  if (!known.empty() && static_cast<double>(known.rbegin()->first - stamp_ns) / 1e9 > max_gap_) {
    // What is known of later instants would hide what comes.
    known_ -= known.size();
    known.clear();
    frame.went_back = went_back_ = true;
  }
  if (!known.empty() && stamp_ns < known.rbegin()->first - kKnown) return;
  const std::size_t before = known.size();
  if (!known.emplace(stamp_ns, transform).second) return;
  known.erase(known.begin(), known.lower_bound(known.rbegin()->first - kKnown));
  known_ += known.size() - before;
  ++taken_;
  if (!frame.went_back) buffer_.setTransform(transform, kAuthority, false);
  if (went_back_ && taken_ >= known_ / kShare) fillAnew();
}

// What is static stays.
void TfRecord::fillAnew() {
  buffer_.clear();
  for (auto& [child, frame] : frames_) {
    for (const auto& [stamp_ns, transform] : frame.known) {
      buffer_.setTransform(transform, kAuthority, false);
    }
    frame.went_back = false;
  }
  went_back_ = false;
  taken_ = 0;
}

std::optional<std::int64_t> TfRecord::firstOf(const std::string& child) const {
  const auto frame = frames_.find(child);
  if (frame == frames_.end() || frame->second.known.empty()) return std::nullopt;
  return frame->second.known.begin()->first;
}

}  // namespace virtual_work_dynamics
