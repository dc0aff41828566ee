#pragma once

#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {

/// Efforts and reactions of joints by Lagrange's equations, in long double. With closed loops they
/// take the closures' wrenches from the solution and find everything else by themselves, on the
/// tree with these wrenches applied to it. The efforts of passive joints vanish when the solution
/// is right.
class LagrangeRows {
 public:
  /// Computes the request of `dynamics`, which must outlive it.
  LagrangeRows(const Mechanism& mechanism, const Dynamics& dynamics);

  /// Returns the results with efforts and reactions of joints replaced; reactions of closures and
  /// efforts of actuated closures stay. Valid until the next call.
  /// @param load with which `results` were computed
  const Results& compute(const Motion& motion, const Load& load, const Results& results);

 private:
  const Dynamics& dynamics_;
  LagrangeDynamics<long double> lagrange_;
  // By entry of the request: its place in the tree's request; -1 for a closure.
  std::vector<int> child_places_, root_places_;
  Load load_;  // of the tree
  Results results_;
};

}  // namespace virtual_work_dynamics
