#pragma once

#include <vector>

#include "motion/stream_identification.h"

namespace virtual_work_dynamics {

/// Number of samples in blocks that are about `block_time` long, s; at least one.
int blockSize(double block_time, double interval);

/// Means of `size` samples after the other; what is left at the end is left out.
std::vector<StreamBlock> averaged(const std::vector<StreamBlock>& samples, int size);

/// Positions that leastStep() takes.
constexpr int kStepPositions = 5;

/// The step that positions are rounded to, if they are: the least difference of second to fourth
/// order among kStepPositions of them that is not zero. Differences of first order would take a
/// steady motion for a step. Infinite: all are zero, but for the rounding of numbers.
double leastStep(const double* positions);

/// Standard deviation that positions rounded to this step, of this magnitude, cannot be better
/// than. Positive.
double leastNoise(double step, double position);
/// That of all these positions.
double leastNoise(const std::vector<double>& positions);

/// A model that follows the samples, for those that nothing can be learnt from.
StreamModel unlearnt(const StreamKnowledge& knowledge, double interval);

}  // namespace virtual_work_dynamics
