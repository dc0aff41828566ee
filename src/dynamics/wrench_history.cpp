#include "dynamics/wrench_history.h"

namespace virtual_work_dynamics {

WrenchHistory::Verdict WrenchHistory::push(const MeasuredWrench& wrench) {
  if (size_ > 0) {
    const std::int64_t ahead = wrench.stamp_ns - at(size_ - 1).stamp_ns;
    if (ahead == 0) return Verdict::kEqualStamp;
    if (ahead < 0 && ahead >= -timeout_ns_) return Verdict::kTooLate;
    if (ahead < 0) size_ = 0;
  }
  if (size_ == kMost) {
    first_ = (first_ + 1) % kMost;
    --size_;
  }
  ring_[(first_ + size_++) % kMost] = wrench;
  return Verdict::kTaken;
}

WrenchHistory::Reading WrenchHistory::read(std::int64_t stamp_ns) const {
  // Bisection for the first measurement that is later.
  std::size_t later = 0;
  for (std::size_t end = size_; later < end;) {
    const std::size_t middle = later + (end - later) / 2;
    if (at(middle).stamp_ns > stamp_ns) {
      end = middle;
    } else {
      later = middle + 1;
    }
  }
  Reading reading;
  if (later == 0) return reading;
  const MeasuredWrench& before = at(later - 1);
  const std::int64_t age = stamp_ns - before.stamp_ns;
  if (age > timeout_ns_) return reading;
  reading.before = &before;
  reading.held = age > 0;
  if (later == size_) return reading;
  const std::int64_t interval = at(later).stamp_ns - before.stamp_ns;
  if (interval > timeout_ns_) return reading;
  reading.after = &at(later);
  reading.share = static_cast<double>(age) / static_cast<double>(interval);
  reading.held = false;
  return reading;
}

}  // namespace virtual_work_dynamics
