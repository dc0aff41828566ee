#pragma once

#include <cstddef>
#include <vector>

#include "estimator/effort_judge.h"
#include "estimator/encoder_stream.h"

namespace virtual_work_dynamics {

/// The filter of Savitzky and Golay of order 5 whose window is chosen with hindsight, by the true
/// efforts, for one recording that is sampled evenly.
class SavitzkyGolay {
 public:
  /// Chooses the window, and whether velocities (smoothed, with their derivative) are better than
  /// derivatives of the positions.
  SavitzkyGolay(const EncoderRecording& recording, const EffortJudge& judge);

  int window() const { return window_; }
  double error() const { return error_; }
  /// The motions at these rows. Near the ends of the recording windows lie on one side.
  std::vector<Motion> motions(const EncoderRecording& recording,
                              const std::vector<std::size_t>& rows) const;

 private:
  int window_ = 0;
  bool from_velocities_ = false;
  double error_;
};

/// What the estimator did before it learnt from the samples: order 3 over nine samples, evaluated
/// in their middle; velocities are fitted together with the positions.
std::vector<Motion> nineSamples(const EncoderRecording& recording,
                                const std::vector<std::size_t>& rows);

}  // namespace virtual_work_dynamics
