#pragma once

#include <cstddef>
#include <vector>

#include "estimator/encoder_stream.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// What the package's estimator makes of some rows of a recording.
struct EstimatedRows {
  std::vector<Motion> motions;  ///< without joints where none was given
  std::vector<MotionCovariance> covariances;
  std::vector<StreamQuality> qualities;  ///< of each joint, at the end
  std::size_t missing = 0;               ///< rows without a motion
};

/// completeMotion().
EstimatedRows complete(const Mechanism& mechanism, const EncoderRecording& recording,
                       const std::vector<std::size_t>& rows,
                       const CompletionSettings& settings = {});

/// MotionEstimator, as the node uses it.
EstimatedRows estimate(const Mechanism& mechanism, const EncoderRecording& recording,
                       const std::vector<std::size_t>& rows, const EstimatorSettings& settings);

/// ns of the processor's time that MotionEstimator takes per sample, pushed and evaluated, after
/// the first second; the least of five rounds.
double timePerSample(const Mechanism& mechanism, const EncoderRecording& recording,
                     const EstimatorSettings& settings);

}  // namespace virtual_work_dynamics
