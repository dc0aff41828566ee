#pragma once

#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {

/// Efforts and reactions of joints by Lagrange's equations, in long double. Of closed loops they
/// take what acts in the closures from the solution and find all else by themselves, on the tree
/// with these wrenches applied to it: that the efforts of passive joints vanish says that the
/// solution is one.
class LagrangeRows {
 public:
  /// Of the request of `dynamics`, which must outlive it.
  LagrangeRows(const Mechanism& mechanism, const Dynamics& dynamics);

  /// The results with efforts and reactions of joints replaced; those of closures, and of actuated
  /// closures, stay. Valid until it is called again.
  const Results& compute(const Motion& motion, const Results& results);

 private:
  const Dynamics& dynamics_;
  LagrangeDynamics<long double> lagrange_;
  // Where the entries of the request are in that of the tree; -1: a closure.
  std::vector<int> child_places_, root_places_;
  Load load_;
  Results results_;
};

}  // namespace virtual_work_dynamics
