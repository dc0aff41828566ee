#pragma once

#include <cstddef>
#include <vector>

#include "estimator/effort_judge.h"
#include "estimator/encoder_stream.h"

namespace virtual_work_dynamics {

/// What a fixed lag allows: for each lag the least error of a Kalman smoother (white snap) that
/// knows the true noises of positions, velocities and stamps, over the density of the motion chosen
/// with hindsight, by the true efforts.
/// @param lags s.
/// @returns the error for each lag, as EffortJudge gives it.
std::vector<double> leastErrorsWithLag(const EncoderRecording& recording, const EffortJudge& judge,
                                       const std::vector<double>& lags);

}  // namespace virtual_work_dynamics
