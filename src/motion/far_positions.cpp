#include "motion/far_positions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace virtual_work_dynamics {
namespace {

/// Steps that are far: longer than this, rad or m, with this acceleration, rad/s^2 or m/s^2, and so
/// many of the smallest and of the usual deviations: white noise makes differences of steps with
/// sqrt(6) of its own.
constexpr double kLongStep = 0.01;
constexpr double kAcceleration = 200;
constexpr double kLeastDeviations = 20;
constexpr double kDeviations = 20;

/// By how much a step is faster than usual and later ones when it is not of their motion.
constexpr double kIsolated = 10;
/// By how much the step after is shorter or longer at most where both are of one motion.
constexpr double kAlike = 2;
/// Part of a step that may be missing on the way back.
constexpr double kReturn = 0.2;
/// Samples that stand alone, at most, and those after a jump that are needed.
constexpr int kMostAlone = 2;
constexpr int kAfterJump = 2;
/// Other steps that tell what is usual.
constexpr int kFewestOthers = 5;

/// The steps from sample to sample of a window.
class Steps {
 public:
  Steps(const double* times, const double* positions, int count, double interval)
      : count_(count - 1) {
    for (int i = 0; i < count_; ++i)
      speeds_[static_cast<std::size_t>(i)] =
          std::abs(positions[i + 1] - positions[i]) / std::max(times[i + 1] - times[i], interval);
  }

  double speed(int step) const { return speeds_[static_cast<std::size_t>(step)]; }
  int others(int first, int last) const { return count_ - (last + 1 - first); }

  /// Whether a step is much faster than half of those before `first` and after `last`.
  bool unusual(int step, int first, int last) const {
    std::array<double, kBeforeFar + kMostFar> rest;
    std::size_t size = 0;
    for (int i = 0; i < count_; ++i)
      if (i < first || i > last) rest[size++] = speed(i);
    const auto middle = rest.begin() + static_cast<std::ptrdiff_t>(size / 2);
    std::nth_element(rest.begin(), middle, rest.begin() + static_cast<std::ptrdiff_t>(size));
    return speed(step) > kIsolated * *middle;
  }

 private:
  int count_;
  std::array<double, kBeforeFar + kMostFar> speeds_;
};

/// Whether the second of two steps is like the first.
bool goesOn(const double* times, const double* positions, double interval) {
  const double first = (positions[1] - positions[0]) / std::max(times[1] - times[0], interval);
  const double second = (positions[2] - positions[1]) / std::max(times[2] - times[1], interval);
  return second * first > 0 && std::abs(second) < kAlike * std::abs(first) &&
         std::abs(first) < kAlike * std::abs(second);
}

}  // namespace

bool isFar(double step, double time, double interval, double least, double deviation) {
  const double usual = std::max(time, interval);
  return std::abs(step) > std::max({kLongStep, kAcceleration * usual * usual,
                                    kLeastDeviations * least, kDeviations * deviation});
}

FarFinding judgeFar(const double* times, const double* positions, int first, int count,
                    double interval) {
  const Steps steps(times, positions, count, interval);
  const int after = count - 1 - first;
  const bool last_chance = count - first >= kMostFar;
  const FarFinding later{last_chance ? FarVerdict::kMotion : FarVerdict::kOpen, 0};
  const int far = first - 1;  // the step to the far sample
  const double way = std::abs(positions[first] - positions[first - 1]);
  if (after > 0 && goesOn(times + far, positions + far, interval)) return {FarVerdict::kMotion, 0};
  for (int alone = 1; alone <= std::min(kMostAlone, after); ++alone) {
    if (!(std::abs(positions[first + alone] - positions[first - 1]) < kReturn * way)) continue;
    const int back = far + alone;
    if (steps.others(far, back) < kFewestOthers) return later;
    if (steps.unusual(far, far, back)) return {FarVerdict::kAlone, alone};
    return {FarVerdict::kMotion, 0};
  }
  if (after < kAfterJump) return later;
  for (int step = first; step < first + kAfterJump; ++step)
    if (steps.speed(far) <= kIsolated * steps.speed(step)) return {FarVerdict::kMotion, 0};
  if (steps.others(far, far) < kFewestOthers) return later;
  return {steps.unusual(far, far, far) ? FarVerdict::kJump : FarVerdict::kMotion, 0};
}

}  // namespace virtual_work_dynamics
