#include "ros/effort_measurements.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// Joint states after which it is named what joints lack: several drivers publish in turn.
constexpr std::size_t kPatience = 100;

}  // namespace

EffortMeasurements::EffortMeasurements(std::vector<std::string> coordinates, double max_gap)
    : names_(std::move(coordinates)),
      max_gap_ns_(std::llround(std::min(max_gap, 1e9) * 1e9)),
      rest_(names_.size(), kUnknown),
      rings_(names_.size()) {
  for (Ring& ring : rings_) ring.values.resize(kMost);
  latest_.stamps_ns.resize(names_.size());
  for (auto* values : {&latest_.q, &latest_.qd, &latest_.effort}) values->resize(names_.size());
  clearLatest();
}

void EffortMeasurements::setRest(int coordinate, double position) {
  rest_[static_cast<std::size_t>(coordinate)] = position;
  clearLatest();
}

void EffortMeasurements::clearLatest() {
  latest_.stamp_ns = kNever;
  std::fill(latest_.stamps_ns.begin(), latest_.stamps_ns.end(), kNever);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    latest_.q[i] = rest_[i];
    latest_.qd[i] = std::isnan(rest_[i]) ? kUnknown : 0;
    latest_.effort[i] = kUnknown;
  }
}

void EffortMeasurements::restart() {
  for (Ring& ring : rings_) ring.size = 0;
  taken_ = 0;
  clearLatest();
}

void EffortMeasurements::take(const JointSample& sample) {
  if (users_ == 0) return;
  latest_.stamp_ns = std::max(latest_.stamp_ns, sample.stamp_ns);
  ++taken_;
  for (int i = 0; i < sample.count; ++i) {
    const auto coordinate = static_cast<std::size_t>(sample.coordinates[i]);
    if (coordinate >= rings_.size()) continue;  // a length
    // What comes late is in between others of the joint, which stand for it.
    if (sample.stamp_ns <= latest_.stamps_ns[coordinate]) continue;
    latest_.stamps_ns[coordinate] = sample.stamp_ns;
    const double effort = sample.effort ? sample.effort[i] : kUnknown;
    latest_.q[coordinate] = sample.q[i];
    latest_.qd[coordinate] = sample.qd ? sample.qd[i] : kUnknown;
    latest_.effort[coordinate] = effort;
    Ring& ring = rings_[coordinate];
    ring.seen = true;
    if (!std::isfinite(effort)) continue;
    if (ring.size == kMost) {
      ring.first = (ring.first + 1) % kMost;
      --ring.size;
    }
    ring.values[(ring.first + ring.size++) % kMost] = {sample.stamp_ns, effort};
  }
}

std::optional<std::string> EffortMeasurements::news() {
  if (taken_ < kPatience) return std::nullopt;
  if (auto text = newsOfEfforts()) return text;
  return newsOfMotions();
}

std::optional<std::string> EffortMeasurements::newsOfEfforts() {
  if (efforts_told_) return std::nullopt;
  efforts_told_ = true;
  std::vector<std::string> without;
  for (std::size_t i = 0; i < rings_.size(); ++i) {
    if (rings_[i].seen && rings_[i].size == 0) without.push_back(names_[i]);
  }
  if (without.empty()) return std::nullopt;
  return "there are no measured efforts of " + namesInQuotes(without) +
         ", which then have no external effort";
}

std::optional<std::string> EffortMeasurements::newsOfMotions() {
  if (motions_told_ || observers_ == 0) return std::nullopt;
  std::vector<std::string> without;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!std::isfinite(latest_.q[i]) || !std::isfinite(latest_.qd[i])) without.push_back(names_[i]);
  }
  motions_told_ = true;
  if (without.empty()) return std::nullopt;
  return "there is no position or no velocity of " + namesInQuotes(without) +
         ", without which the momentum observer has no external effort of any joint";
}

double EffortMeasurements::at(std::size_t coordinate, std::int64_t stamp_ns) const {
  const Ring& ring = rings_[coordinate];
  std::size_t later = 0;
  for (std::size_t end = ring.size; later < end;) {
    const std::size_t middle = later + (end - later) / 2;
    if (ring.at(middle).stamp_ns > stamp_ns) {
      end = middle;
    } else {
      later = middle + 1;
    }
  }
  if (later == 0) return kUnknown;
  const Measured& before = ring.at(later - 1);
  if (before.stamp_ns == stamp_ns) return before.effort;
  if (later == ring.size || ring.at(later).stamp_ns - before.stamp_ns > max_gap_ns_) {
    return kUnknown;
  }
  const Measured& after = ring.at(later);
  const double share = static_cast<double>(stamp_ns - before.stamp_ns) /
                       static_cast<double>(after.stamp_ns - before.stamp_ns);
  return before.effort + share * (after.effort - before.effort);
}

}  // namespace virtual_work_dynamics
