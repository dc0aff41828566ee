#pragma once

#include <vector>

#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// How far a motion violates each closure, in units and relative. Nothing after construction
/// allocates.
class LoopResiduals {
 public:
  /// @param length of the loops, m
  LoopResiduals(const Mechanism& mechanism, std::size_t closures, double length);

  /// Computes the residuals of a motion at the position of `kinematics`.
  void set(LoopKinematics& kinematics, const Motion& motion);
  /// Sets those of a motion from norms that were found already.
  /// @param norms by closure, by level: plain and relative, `stride` numbers apart
  void setFromNorms(const Motion& motion, const double* norms, std::size_t stride);

  const std::vector<ClosureResidual>& values() const { return values_; }
  const std::vector<ClosureResidual>& relative() const { return relative_; }

 private:
  double largest(const Eigen::VectorXd& rates) const;

  std::vector<double> scales_;  // by coordinate: 1 or the length
  double length_;
  std::vector<double> norms_;
  std::vector<ClosureResidual> values_, relative_;
};

}  // namespace virtual_work_dynamics
