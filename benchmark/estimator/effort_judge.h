#pragma once

#include <cstddef>
#include <vector>

#include "estimator/encoder_stream.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// Compares efforts computed from estimated motions with those of the true motion at some rows of a
/// recording.
class EffortJudge {
 public:
  EffortJudge(const InverseDynamics& dynamics, const EncoderRecording& recording,
              std::vector<std::size_t> rows);

  const std::vector<std::size_t>& rows() const { return rows_; }
  /// The true motion at rows()[i].
  const Motion& truth(std::size_t i) const { return truths_[i]; }
  /// The true efforts at rows()[i], N m.
  const Eigen::VectorXd& effort(std::size_t i) const { return efforts_[i]; }

  /// Rms of the effort's error over the rms of the effort, of the joint where this is largest.
  /// @param estimates one motion for each of rows(); those without joints are left out.
  /// @returns infinity if none has joints.
  double error(const std::vector<Motion>& estimates) const;

 private:
  const InverseDynamics& dynamics_;
  std::vector<std::size_t> rows_;
  std::vector<Motion> truths_;
  std::vector<Eigen::VectorXd> efforts_;
};

}  // namespace virtual_work_dynamics
