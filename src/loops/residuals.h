#pragma once

#include <vector>

#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// How far a motion violates each set of conditions, in units and relative. Nothing after
/// construction allocates.
class LoopResiduals {
 public:
  /// @param kinematics whose conditions it is about; must outlive it
  /// @param length of the loops, m
  LoopResiduals(const Mechanism& mechanism, const LoopKinematics& kinematics, double length);

  /// Computes the residuals of a motion at the position of `kinematics`.
  /// @param plain, relative receive one for each set
  void find(LoopKinematics& kinematics, const Motion& motion, std::vector<ClosureResidual>& plain,
            std::vector<ClosureResidual>& relative) const;
  /// As kernels see them.
  const ResidualsView& view() const { return view_; }

 private:
  const LoopFunctions* kernel_;
  std::vector<double> scales_;  // by coordinate: 1 or the length
  std::vector<int> lengths_;    // by set: how many of its conditions are lengths
  ResidualsView view_;
};

}  // namespace virtual_work_dynamics
