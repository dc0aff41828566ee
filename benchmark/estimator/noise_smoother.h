#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "estimator/encoder_stream.h"
#include "motion/stream_model.h"

namespace virtual_work_dynamics {

/// Smooths a whole recording as motion in which the derivative of a fixed order is white noise, for
/// what the estimator chooses among to be judged one by one. Knows the times at which rows were
/// really read.
class NoiseSmoother {
 public:
  /// Noises by likelihood. @param order 3 (white jerk) to 5.
  static NoiseSmoother byLikelihood(const EncoderRecording& recording, int order);
  /// The quintic smoothing spline, which is white jerk, by generalized cross-validation (Craven and
  /// Wahba 1979; Woltring 1986). Uses positions.
  static NoiseSmoother spline(const EncoderRecording& recording);

  std::vector<Motion> motions(const std::vector<std::size_t>& rows) const;

 private:
  NoiseSmoother(const EncoderRecording& recording, int order)
      : recording_(recording), order_(order) {}

  const EncoderRecording& recording_;
  int order_;
  std::array<StreamModel, kArmJoints> models_;
};

}  // namespace virtual_work_dynamics
