#pragma once

#include <cstdint>

namespace virtual_work_dynamics {

/// The instants at which a motion is sampled, in whole nanoseconds from its start: evenly spaced,
/// with the end of the motion as the last one. The step before the end is shorter or longer, by
/// half at most, when the duration is not a multiple of the spacing.
class SampleTimes {
 public:
  /// @param duration duration of the motion, s, up to 1e9; zero: a single sample.
  /// @param rate samples per second, Hz, positive, up to 1e6.
  SampleTimes(double duration, double rate);

  /// Index of the last sample; the first is 0.
  std::int64_t last() const { return last_; }
  /// Time of sample k, 0 <= k <= last(), from the start, ns.
  std::int64_t offset(std::int64_t k) const;
  /// Time of sample k from the start, s, rounded to double and never beyond the duration.
  double time(std::int64_t k) const;

  std::int64_t durationNs() const { return duration_ns_; }
  /// Spacing of the samples, ns.
  std::int64_t stepNs() const { return step_ns_; }

 private:
  double duration_;
  double rate_;
  std::int64_t duration_ns_;
  std::int64_t step_ns_;
  std::int64_t last_;
};

}  // namespace virtual_work_dynamics
