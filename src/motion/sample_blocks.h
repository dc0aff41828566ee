#pragma once

#include <vector>

#include "motion/stream_identification.h"

namespace virtual_work_dynamics {

/// Number of samples in blocks that are about `block_time` long, s; at least one.
int blockSize(double block_time, double interval);

/// Means of `size` samples after the other; what is left at the end is left out.
std::vector<StreamBlock> averaged(const std::vector<StreamBlock>& samples, int size);

/// Standard deviation that no position of these can be better than: that of rounding to the least
/// step between neighbours, and to the last digits of a number. Positive.
double leastNoise(const std::vector<double>& positions);

/// A model that follows the samples, for those that nothing can be learnt from.
StreamModel unlearnt(const StreamKnowledge& knowledge, double interval);

}  // namespace virtual_work_dynamics
