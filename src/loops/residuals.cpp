#include "loops/residuals.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

LoopResiduals::LoopResiduals(const Mechanism& mechanism, std::size_t closures, double length)
    : length_(length), values_(closures), relative_(closures) {
  for (int i = 0; i < static_cast<int>(mechanism.coordinates().size()); ++i) {
    scales_.push_back(scaleOf(mechanism.unitOf(i), length));
  }
}

void LoopResiduals::set(LoopKinematics& kinematics, const Motion& motion) {
  kinematics.setMotion(motion);
  // Where nearly nothing moves, rates are compared with 1/s.
  const double rate = std::max(1.0, largest(motion.qd));
  const double acceleration = std::max({1.0, largest(motion.qdd), rate * rate});
  for (std::size_t c = 0; c < values_.size(); ++c) {
    const auto set = [&](double ClosureResidual::*level, const Eigen::VectorXd& conditions,
                         double scale) {
      const LoopKinematics::LargerNorm norm =
          kinematics.largerNormOf(c, conditions, 1 / length_);
      values_[c].*level = norm.plain;
      relative_[c].*level = norm.relative / scale;
    };
    set(&ClosureResidual::position, kinematics.phi(), 1);
    set(&ClosureResidual::velocity, kinematics.rates(), rate);
    set(&ClosureResidual::acceleration, kinematics.accelerations(), acceleration);
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
