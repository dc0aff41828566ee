#pragma once

#include <vector>

#include "tree/plan.h"
#include "virtual_work_dynamics/load.h"

namespace virtual_work_dynamics {

/// Force and torque of the applied wrenches as the kernels read them.
template <typename R>
class AppliedValues {
 public:
  explicit AppliedValues(const Plan<R>& plan);

  const PlainWrench<R>* data() const { return values_.data(); }

  /// Takes the values of a load. Does not allocate.
  /// @throws SceneError when it has not one wrench for each applied one.
  void set(const Plan<R>& plan, const Load& load);

 private:
  std::vector<PlainWrench<R>> values_;
};

}  // namespace virtual_work_dynamics
