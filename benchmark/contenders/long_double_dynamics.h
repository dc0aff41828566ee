#pragma once

#include <memory>
#include <vector>

#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// The recursion for one sample in long double, for measurements in which double does not suffice.
/// Scenes must not have applied wrenches; poses and twists are left out. One instance serves one
/// thread.
class LongDoubleDynamics {
 public:
  /// @throws as InverseDynamics does.
  LongDoubleDynamics(const Mechanism& mechanism, const Scene& scene, const Request& request);
  ~LongDoubleDynamics();
  LongDoubleDynamics(LongDoubleDynamics&&) noexcept;

  /// Computes one sample; the arrays have one number for each generalized coordinate. Does not
  /// allocate.
  void compute(const long double* q, const long double* qd, const long double* qdd);

  /// The efforts, in the order of the rows of a ResultBlock.
  const std::vector<long double>& efforts() const;
  const std::vector<long double>& childAxes() const;
  const std::vector<long double>& rootAxes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
