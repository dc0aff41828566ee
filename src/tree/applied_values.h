#pragma once

#include <cstddef>
#include <vector>

#include "tree/plan.h"
#include "virtual_work_dynamics/load.h"

namespace virtual_work_dynamics {

/// Force and torque of the applied wrenches as the kernels read them, for samples side by side.
template <typename R>
class AppliedValues {
 public:
  /// Takes the scene's values. @param samples that are computed at once
  explicit AppliedValues(const Plan<R>& plan, std::size_t samples = 1);

  /// See KernelInputs::applied and applied_stride.
  const R* data() const { return values_.data(); }
  std::size_t stride() const { return samples_; }

  /// Takes the values of a load for all samples. Does not allocate.
  /// @throws SceneError when it has not one wrench for each applied one.
  void set(const Plan<R>& plan, const Load& load);
  /// Takes the values of a load, which must have one wrench for each applied one, for one sample.
  /// Does not allocate.
  void setSample(const Plan<R>& plan, const Load& load, std::size_t sample);

 private:
  void store(std::size_t wrench, std::size_t sample, const PlainWrench<R>& value);

  std::size_t samples_;
  std::vector<R> values_;
};

}  // namespace virtual_work_dynamics
