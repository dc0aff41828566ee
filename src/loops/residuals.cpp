#include "loops/residuals.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

LoopResiduals::LoopResiduals(const Mechanism& mechanism, std::size_t closures, double length)
    : length_(length), norms_(6 * closures), values_(closures), relative_(closures) {
  for (int i = 0; i < static_cast<int>(mechanism.coordinates().size()); ++i) {
    scales_.push_back(scaleOf(mechanism.unitOf(i), length));
  }
}

void LoopResiduals::set(LoopKinematics& kinematics, const Motion& motion) {
  kinematics.setMotion(motion);
  double* norm = norms_.data();
  for (std::size_t c = 0; c < values_.size(); ++c) {
    for (const Eigen::VectorXd* conditions :
         {&kinematics.phi(), &kinematics.rates(), &kinematics.accelerations()}) {
      kinematics.findNorms(c, *conditions, 1 / length_, norm);
      norm += 2;
    }
  }
  setFromNorms(motion, norms_.data(), 1);
}

void LoopResiduals::setFromNorms(const Motion& motion, const double* norms, std::size_t stride) {
  // Where nearly nothing moves, rates are compared with 1/s.
  const double rate = std::max(1.0, largest(motion.qd));
  const double acceleration = std::max({1.0, largest(motion.qdd), rate * rate});
  const double shares[] = {1, 1 / rate, 1 / acceleration};
  constexpr double ClosureResidual::*kLevels[] = {
      &ClosureResidual::position, &ClosureResidual::velocity, &ClosureResidual::acceleration};
  for (std::size_t c = 0; c < values_.size(); ++c) {
    for (std::size_t level = 0; level < 3; ++level) {
      values_[c].*kLevels[level] = norms[0];
      relative_[c].*kLevels[level] = norms[stride] * shares[level];
      norms += 2 * stride;
    }
  }
}

double LoopResiduals::largest(const Eigen::VectorXd& rates) const {
  double value = 0;
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    value = std::max(value, std::abs(rates[static_cast<Eigen::Index>(i)]) / scales_[i]);
  }
  return value;
}

}  // namespace virtual_work_dynamics
