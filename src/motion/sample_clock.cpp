#include "motion/sample_clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "motion/stream_smoother.h"

namespace virtual_work_dynamics {
namespace {

/// Fewest stamps that show a clock.
constexpr std::size_t kFewest = 64;
/// Rows over which the interval is measured first: few enough that most such stretches have all of
/// their rows.
constexpr std::size_t kClockStretch = 24;
/// Rows ahead over which a missing row has to show.
constexpr std::size_t kAhead = 12;
/// Most ticks that may be missing among them; a longer gap is measured by its own length.
constexpr int kMostMissing = 4;
/// Cost of a missing tick, in variances of a stamp's deviation.
constexpr double kSurprise = 8;
/// Standard deviation of stamps to begin with, in intervals.
constexpr double kFirstDeviation = 0.1;
/// Gains of the loop that follows phase and frequency of the clock.
constexpr double kPhaseGain = 0.02;
constexpr double kFrequencyGain = 1e-4;
/// Time over which the clock may drift, s.
constexpr double kDrift = 0.5;
/// Stamps whose deviations from even ones are less than this part of the interval are even.
constexpr double kEven = 1e-3;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double firstInterval(const std::vector<double>& stamps) {
  std::vector<double> intervals;
  for (std::size_t i = kClockStretch; i < stamps.size(); ++i)
    intervals.push_back((stamps[i] - stamps[i - kClockStretch]) /
                        static_cast<double>(kClockStretch));
  return median(std::move(intervals));
}

/// Number of the tick of each stamp.
class TickCount {
 public:
  explicit TickCount(const std::vector<double>& stamps) : stamps_(stamps) {}

  std::vector<double> count() {
    std::vector<double> ticks(stamps_.size());
    double interval = firstInterval(stamps_);
    double expected = stamps_[0];
    variance_ = std::pow(kFirstDeviation * interval, 2);
    double tick = 0;
    for (std::size_t row = 0; row < stamps_.size(); ++row) {
      const int missing = missingAt(row, expected, interval);
      tick += missing;
      expected += missing * interval;
      ticks[row] = tick;
      const double error = std::clamp(stamps_[row] - expected, -interval, interval);
      variance_ += kPhaseGain * (error * error - variance_);
      interval += kFrequencyGain * error;
      expected += kPhaseGain * error + interval;
      tick += 1;
    }
    return ticks;
  }

 private:
  /// Ticks without a row just before this one: the first step of the most likely sequence of steps
  /// over the rows ahead, where each row may miss ticks before it.
  int missingAt(std::size_t row, double expected, double interval) const {
    const double late = (stamps_[row] - expected) / interval;
    if (late > kMostMissing) return static_cast<int>(std::lround(late));
    const double missing_costs = kSurprise * variance_;
    // Of the best sequence that ends with k ticks missed: its cost, and its first step.
    std::array<double, kMostMissing + 1> costs{};
    std::array<int, kMostMissing + 1> first_steps{};
    const std::size_t end = std::min(row + kAhead, stamps_.size());
    for (std::size_t i = row; i < end; ++i) {
      const double delay = stamps_[i] - expected - static_cast<double>(i - row) * interval;
      std::array<double, kMostMissing + 1> best{};
      std::array<int, kMostMissing + 1> best_first{};
      for (int k = 0; k <= kMostMissing; ++k) {
        const auto now = static_cast<std::size_t>(k);
        best[now] = std::numeric_limits<double>::infinity();
        for (int before = i == row ? 0 : k; before >= 0; --before) {
          const auto then = static_cast<std::size_t>(before);
          const double cost = (i == row ? 0 : costs[then]) + missing_costs * (k - before);
          if (cost >= best[now]) continue;
          best[now] = cost;
          best_first[now] = i == row ? k : first_steps[then];
        }
        best[now] += std::pow(delay - k * interval, 2);
      }
      costs = best;
      first_steps = best_first;
    }
    const auto least = std::min_element(costs.begin(), costs.end());
    return first_steps[static_cast<std::size_t>(least - costs.begin())];
  }

  const std::vector<double>& stamps_;
  double variance_ = 0;  // of the stamps' deviations, s^2
};

}  // namespace

double usualInterval(const std::vector<double>& stamps) {
  if (stamps.size() < 2) return 1;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  return median(std::move(intervals));
}

std::vector<double> evenTimes(const std::vector<double>& stamps) {
  if (stamps.size() < kFewest) return {};
  const std::vector<double> ticks = TickCount(stamps).count();
  // What is left when steps of one interval are taken away is slow drift and noise of the stamps.
  const double interval = (stamps.back() - stamps.front()) / (ticks.back() - ticks.front());
  std::vector<StreamBlock> rest(stamps.size());
  double squares = 0;
  double noise = 0;
  for (std::size_t row = 0; row < stamps.size(); ++row) {
    const double even = stamps[0] + interval * ticks[row];
    rest[row] = {even, stamps[row] - even, std::numeric_limits<double>::quiet_NaN()};
    squares += rest[row].position * rest[row].position;
    if (row > 0) noise += std::pow(rest[row].position - rest[row - 1].position, 2) / 2;
  }
  noise /= static_cast<double>(stamps.size() - 1);
  if (squares < std::pow(kEven * interval, 2) * static_cast<double>(stamps.size())) return {};
  StreamModel model;
  model.position_variance = std::max(noise, std::pow(1e-6 * interval, 2));
  model.density = densityFor(kDrift, model.position_variance, 3, interval);
  std::vector<double> times(stamps.size());
  smoothStream(rest, model, 3, interval, std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity(), false,
               [&](std::size_t row, const SmoothedSample& sample) {
                 times[row] = rest[row].time + sample.motion[0];
               });
  for (std::size_t row = 1; row < times.size(); ++row)
    if (!(times[row] > times[row - 1])) return {};
  return times;
}

}  // namespace virtual_work_dynamics
