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

}  // namespace

template <typename R>
AppliedValues<R>::AppliedValues(const Plan<R>& plan) {
  for (const auto& where : plan.applied) values_.push_back(valueAt(where, where.given));
}

template <typename R>
void AppliedValues<R>::set(const Plan<R>& plan, const Load& load) {
  requireLoad(load, values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Eigen::Vector3d &force = load.wrenches[i].force, &torque = load.wrenches[i].torque;
    values_[i] =
        valueAt(plan.applied[i], PlainWrench<R>{{R(force.x()), R(force.y()), R(force.z())},
                                                {R(torque.x()), R(torque.y()), R(torque.z())}});
  }
}

template class AppliedValues<float>;
template class AppliedValues<double>;

}  // namespace virtual_work_dynamics
