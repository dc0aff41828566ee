#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "offline/loop_sample.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {

/// Efforts and reactions of joints by Lagrange's equations of the tree, with the wrenches that
/// closed loops were solved for applied to it: multipliers, seen from the other formalism. It takes
/// from the solution what acts in the closures and finds all else by itself: that the efforts of
/// passive joints vanish says that the solution is one.
class LoopLagrange {
 public:
  /// Of the same request.
  LoopLagrange(const Mechanism& mechanism, const ClosedLoopDynamics& loops);

  /// Of the same motion.
  void compute(const LoopSample& loops);

  // In the order of the request; efforts of actuated closures behind those of coordinates.
  const Eigen::VectorXd& effort() const { return effort_; }
  const std::vector<Wrench>& childAxes() const { return child_axes_; }
  const std::vector<Wrench>& rootAxes() const { return root_axes_; }

 private:
  LagrangeDynamics<long double> lagrange_;
  // Where the entries of the request are in that of the tree; -1: a closure.
  std::vector<int> child_places_, root_places_;
  Eigen::VectorXd effort_;
  std::vector<Wrench> child_axes_, root_axes_;
};

}  // namespace virtual_work_dynamics
