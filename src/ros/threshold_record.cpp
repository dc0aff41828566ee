#include "ros/threshold_record.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace virtual_work_dynamics {

ThresholdRecord::ThresholdRecord(std::vector<std::string> names, std::vector<double> thresholds,
                                 double hold, double max_gap)
    : names_(std::move(names)),
      thresholds_(std::move(thresholds)),
      hold_ns_(std::llround(hold * 1e9)),
      max_gap_ns_(std::llround(std::min(max_gap, 1e9) * 1e9)),
      states_(names_.size()) {}

void ThresholdRecord::record(std::int64_t stamp_ns, const std::vector<double>& values) {
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock) return;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    State& state = states_[i];
    if (!(std::abs(values[i]) > thresholds_[i])) {
      state.beyond = false;
      continue;
    }
    if (!state.beyond || stamp_ns < state.latest_ns || stamp_ns - state.latest_ns > max_gap_ns_) {
      state.since_ns = stamp_ns;
      if (!state.counts) state.peak = 0;
      state.beyond = true;
    }
    state.latest_ns = stamp_ns;
    if (std::abs(values[i]) > std::abs(state.peak)) state.peak = values[i];
    if (stamp_ns - state.since_ns >= hold_ns_) state.counts = true;
  }
}

std::vector<ThresholdRecord::Excess> ThresholdRecord::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Excess> found;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    State& state = states_[i];
    if (!state.counts) continue;
    found.push_back({names_[i], thresholds_[i], state.peak,
                     static_cast<double>(state.latest_ns - state.since_ns) / 1e9});
    // What lasts counts again at the next instant; a new peak begins with it.
    state.counts = false;
    state.peak = 0;
  }
  return found;
}

}  // namespace virtual_work_dynamics
