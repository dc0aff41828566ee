#include "offline/measured_efforts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/number_text.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kSecondNs = 1e9;
constexpr double kLatestSecond = 9e9;  // what 64 bits of nanoseconds hold

}  // namespace

void MeasuredEffort::add(std::int64_t stamp_ns, double effort) {
  stamps_ns_.push_back(stamp_ns);
  values_.push_back(effort);
}

void MeasuredEffort::sort() {
  std::vector<std::size_t> order(stamps_ns_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [this](std::size_t a, std::size_t b) { return stamps_ns_[a] < stamps_ns_[b]; });
  std::vector<std::int64_t> stamps;
  std::vector<double> values;
  for (const std::size_t i : order) {
    if (!stamps.empty() && stamps_ns_[i] == stamps.back()) continue;
    stamps.push_back(stamps_ns_[i]);
    values.push_back(values_[i]);
  }
  stamps_ns_ = std::move(stamps);
  values_ = std::move(values);
}

double MeasuredEffort::at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const auto later = std::upper_bound(stamps_ns_.begin(), stamps_ns_.end(), stamp_ns);
  if (later == stamps_ns_.begin()) return kUnknown;
  const auto before = static_cast<std::size_t>(later - stamps_ns_.begin()) - 1;
  if (stamps_ns_[before] == stamp_ns) return values_[before];
  if (later == stamps_ns_.end() || *later - stamps_ns_[before] > max_gap_ns) return kUnknown;
  const double share = static_cast<double>(stamp_ns - stamps_ns_[before]) /
                       static_cast<double>(*later - stamps_ns_[before]);
  return values_[before] + share * (values_[before + 1] - values_[before]);
}

std::int64_t nanosecondsOf(double time, const std::string& where) {
  if (std::abs(time) < kLatestSecond) return std::llround(time * kSecondNs);
  throw FileError(where + ": the time " + numberText(time) +
                  " s is beyond those at which efforts are measured");
}

std::int64_t instantNs(const MotionFile& file, std::size_t row) {
  return file.stamps_ns.empty() ? nanosecondsOf(file.table.times[row], file.at(row))
                                : file.stamps_ns[row];
}

}  // namespace virtual_work_dynamics
