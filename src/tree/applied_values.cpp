#include "tree/applied_values.h"

#include "scene/input_checks.h"

namespace virtual_work_dynamics {

namespace {

template <typename R>
Vec3<R> times(const Mat3<R>& A, const Vec3<R>& v) {
  return {A.xx * v.x + A.xy * v.y + A.xz * v.z, A.yx * v.x + A.yy * v.y + A.yz * v.z,
          A.zx * v.x + A.zy * v.y + A.zz * v.z};
}

template <typename R>
PlainWrench<R> valueAt(const AppliedOutside<R>& where, const PlainWrench<R>& given) {
  if (where.in_root_axes) return given;
  const Vec3<R> force = times(where.R_ZL, given.force);
  const Vec3<R> torque = times(where.R_ZL, given.torque);
  const Vec3<R>& p = where.p_ZoA_Z;
  return {force,
          {torque.x + (p.y * force.z - p.z * force.y), torque.y + (p.z * force.x - p.x * force.z),
           torque.z + (p.x * force.y - p.y * force.x)}};
}

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
    const PlainWrench<R> value = valueAt(plan.applied[i], plan.applied[i].given);
    for (std::size_t sample = 0; sample < samples_; ++sample) store(i, sample, value);
  }
}

template <typename R>
void AppliedValues<R>::set(const Plan<R>& plan, const Load& load) {
  requireLoad(load, plan.applied.size());
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    const PlainWrench<R> value = valueAt(plan.applied[i], rounded<R>(load.wrenches[i]));
    for (std::size_t sample = 0; sample < samples_; ++sample) store(i, sample, value);
  }
}

template <typename R>
void AppliedValues<R>::setSample(const Plan<R>& plan, const Load& load, std::size_t sample) {
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    store(i, sample, valueAt(plan.applied[i], rounded<R>(load.wrenches[i])));
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
