#pragma once

#include <cstddef>
#include <cstdint>

#include "motion/trajectory_curve.h"
#include "ros/sample_times.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// The samples of a trajectory between its points, evaluated one by one: evenly spaced, with the
/// first and the last point as the first and the last sample.
class TrajectorySamples {
 public:
  /// The most samples of a trajectory.
  static constexpr std::size_t kMost = 1000000;

  /// @param curve starts at time 0.   @param rate Hz.   @param first_ns stamp of the first point.
  TrajectorySamples(TrajectoryCurve curve, double rate, std::int64_t first_ns);

  /// May be more than kMost, which the caller refuses.
  std::size_t count() const { return static_cast<std::size_t>(times_.last()) + 1; }
  std::int64_t stampNs(std::size_t sample) const {
    return first_ns_ + times_.offset(static_cast<std::int64_t>(sample));
  }
  /// Computes the motion of a sample. Does not allocate when `motion` has the right size.
  void evaluate(std::size_t sample, Motion& motion) const {
    curve_.evaluate(times_.time(static_cast<std::int64_t>(sample)), motion);
  }
  const TrajectoryCurve& curve() const { return curve_; }

 private:
  TrajectoryCurve curve_;
  SampleTimes times_;
  std::int64_t first_ns_;
};

}  // namespace virtual_work_dynamics
