#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "motion/stream_identification.h"

namespace virtual_work_dynamics {

/// Time between two stamps in ns, s.
inline double secondsBetween(std::int64_t from, std::int64_t to) {
  return static_cast<double>(to - from) * 1e-9;
}

/// Time from block to block that models are found from, s, unless samples come more slowly.
constexpr double kBlockTime = 0.002;

/// Number of samples in blocks that are about `block_time` long, s; at least one.
int blockSize(double block_time, double interval);

/// Means of `size` samples after the other; what is left at the end, and before a sample that
/// begins a motion, is left out.
std::vector<StreamBlock> averaged(const std::vector<StreamBlock>& samples, int size);

/// Finds the step that positions are rounded to, if they are: the greatest common divisor of their
/// differences of second order, which also change sign all the time. Differences of first order
/// would take a steady motion for a step, and a divisor alone a steady acceleration.
class StepFinder {
 public:
  /// Takes three positions that follow each other, rad or m, of which two were taken before.
  void take(double oldest, double middle, double newest);
  /// The step; infinite where there is none, or where rounding of the numbers hides it.
  double step() const;

 private:
  struct Inexact {
    double value = 0;
    double error = 0;
  };

  static Inexact commonDivisor(Inexact larger, Inexact smaller);

  Inexact divisor_;
  double previous_ = 0;   // difference
  int differences_ = 0;   // that are not zero
  int alternations_ = 0;  // of the sign from one of them to the very next
};

/// Positions that noiseDifference() takes.
constexpr std::size_t kDifferenced = 5;

/// The difference of fourth order, over uneven times, scaled so that white noise of the positions
/// gives it the variance of one of them. Cubics leave nothing of it.
double noiseDifference(const std::array<double, kDifferenced>& times,
                       const std::array<double, kDifferenced>& positions);

/// Standard deviation that positions rounded to this step, of this magnitude, cannot be better
/// than. Positive.
double leastNoise(double step, double position);
/// That of all these positions.
double leastNoise(const std::vector<double>& positions);

/// A model that follows the samples, for those that nothing can be learnt from.
StreamModel unlearnt(const StreamKnowledge& knowledge, double interval);

}  // namespace virtual_work_dynamics
