#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "estimator/encoder_stream.h"

namespace virtual_work_dynamics {

/// Local polynomials of order 5. The window, one for each joint, is the one with the least
/// estimated mean square error of the acceleration: its variance is that of the reading noise,
/// found from the residuals of short windows; its bias is estimated by the difference from
/// polynomials of order 7, less what noise makes of this difference (Fan and Gijbels 1996). Uses
/// positions.
class LocalPolynomial {
 public:
  explicit LocalPolynomial(const EncoderRecording& recording);

  std::vector<Motion> motions(const std::vector<std::size_t>& rows) const;

 private:
  double noiseVariance(const std::vector<std::size_t>& rows, Eigen::Index joint) const;
  Eigen::RowVectorXd meanSquareErrors(const std::vector<std::size_t>& rows, int window,
                                      const Eigen::RowVectorXd& variances) const;

  const EncoderRecording& recording_;
  std::array<int, kArmJoints> windows_{};
};

}  // namespace virtual_work_dynamics
