#pragma once

#include <Eigen/Core>
#include <vector>

#include "tree/plan.h"

namespace virtual_work_dynamics {

/// Force and torque of the applied wrenches as the kernels read them.
template <typename R>
class AppliedValues {
 public:
  explicit AppliedValues(const Plan<R>& plan);

  const PlainWrench<R>* data() const { return values_.data(); }

  /// See Workspace::setAppliedWrench(). @throws SceneError when there is no such wrench.
  void set(const Plan<R>& plan, std::size_t index, const Eigen::Vector3d& force,
           const Eigen::Vector3d& torque);

 private:
  std::vector<PlainWrench<R>> values_;
};

}  // namespace virtual_work_dynamics
