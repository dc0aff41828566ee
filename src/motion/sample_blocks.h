#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "motion/stream_identification.h"

namespace virtual_work_dynamics {

/// Number of samples in blocks that are about `block_time` long, s; at least one.
int blockSize(double block_time, double interval);

/// Means of `size` samples after the other; what is left at the end is left out.
std::vector<StreamBlock> averaged(const std::vector<StreamBlock>& samples, int size);

/// Finds the step that positions are rounded to, if they are: the greatest common divisor of their
/// differences of second order. Those of first order would take a steady motion for a step.
class StepFinder {
 public:
  /// Takes three positions that follow each other, rad or m, of which two were taken before.
  void take(double oldest, double middle, double newest);
  /// The step; infinite where there is none, or where rounding of the numbers hides it.
  double step() const;

 private:
  double noDifference() const;

  double divisor_ = 0;
  double largest_ = 0;    // difference
  double magnitude_ = 0;  // of the positions
  int differences_ = 0;   // that are not zero
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
