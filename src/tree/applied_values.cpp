#include "tree/applied_values.h"

#include "scene/input_checks.h"
#include "tree/applied_at.h"

namespace virtual_work_dynamics {

namespace {

template <typename R>
PlainWrench<R> rounded(const Wrench& wrench) {
  const Eigen::Vector3d &force = wrench.force, &torque = wrench.torque;
  return {{R(force.x()), R(force.y()), R(force.z())},
          {R(torque.x()), R(torque.y()), R(torque.z())}};
}

}  // namespace

template <typename R>
AppliedValues<R>::AppliedValues(const Plan<R>& plan, std::size_t samples)
    : samples_(samples), values_(6 * plan.applied.size() * samples) {
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    const PlainWrench<R> value = appliedAt(plan.applied[i], plan.applied[i].given);
    for (std::size_t sample = 0; sample < samples_; ++sample) store(i, sample, value);
  }
}

template <typename R>
void AppliedValues<R>::set(const Plan<R>& plan, const Load& load) {
  requireLoad(load, plan.applied.size());
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    const PlainWrench<R> value = appliedAt(plan.applied[i], rounded<R>(load.wrenches[i]));
    for (std::size_t sample = 0; sample < samples_; ++sample) store(i, sample, value);
  }
}

template <typename R>
void AppliedValues<R>::setSample(const Plan<R>& plan, const Load& load, std::size_t sample) {
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    store(i, sample, appliedAt(plan.applied[i], rounded<R>(load.wrenches[i])));
  }
}

template <typename R>
void AppliedValues<R>::store(std::size_t wrench, std::size_t sample, const PlainWrench<R>& value) {
  R* to = values_.data() + 6 * wrench * samples_ + sample;
  for (const Vec3<R>* vector : {&value.force, &value.torque}) {
    for (const R number : {vector->x, vector->y, vector->z}) {
      *to = number;
      to += samples_;
    }
  }
}

template class AppliedValues<float>;
template class AppliedValues<double>;

}  // namespace virtual_work_dynamics
