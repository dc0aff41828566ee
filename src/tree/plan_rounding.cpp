#include <algorithm>
#include <iterator>

#include "tree/plan.h"

namespace virtual_work_dynamics {

namespace {

using Real = long double;

template <typename T>
Vec3<T> rounded(const Vec3<Real>& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

template <typename T>
Mat3<T> rounded(const Mat3<Real>& A) {
  return {T(A.xx), T(A.xy), T(A.xz), T(A.yx), T(A.yy), T(A.yz), T(A.zx), T(A.zy), T(A.zz)};
}

template <typename T>
Sym3<T> rounded(const Sym3<Real>& A) {
  return {T(A.xx), T(A.xy), T(A.xz), T(A.yy), T(A.yz), T(A.zz)};
}

template <typename T>
PlainWrench<T> rounded(const PlainWrench<Real>& wrench) {
  return {rounded<T>(wrench.force), rounded<T>(wrench.torque)};
}

template <typename T>
Body<T> rounded(const Body<Real>& from) {
  Body<T> body;
  static_cast<BodyUse&>(body) = from;
  body.multiplier = T(from.multiplier);
  body.R_PZ = rounded<T>(from.R_PZ);
  body.p_PoZo_P = rounded<T>(from.p_PoZo_P);
  body.mass = T(from.mass);
  body.h = rounded<T>(from.h);
  body.G = rounded<T>(from.G);
  body.gamma_rest = rounded<T>(from.gamma_rest);
  return body;
}

template <typename T>
JointPosition<T> rounded(const JointPosition<Real>& from) {
  return {from.coordinate, from.geared,       from.turned,      T(from.multiplier),
          T(from.offset),  T(from.phase_cos), T(from.phase_sin)};
}

template <typename T>
ReactionOutput<T> rounded(const ReactionOutput<Real>& from) {
  ReactionOutput<T> output;
  output.body = from.body;
  output.R_KZ = rounded<T>(from.R_KZ);
  output.permutes = from.permutes;
  output.flips = from.flips;
  std::copy(std::begin(from.row), std::end(from.row), output.row);
  for (int i = 0; i < 3; ++i) output.sign[i] = T(from.sign[i]);
  output.drop_active = from.drop_active;
  output.active = from.active;
  output.pitch = T(from.pitch);
  output.normal_P = rounded<T>(from.normal_P);
  return output;
}

template <typename T>
MovedMoment<T> rounded(const MovedMoment<Real>& from) {
  return {from.output, from.in_root_axes, from.steps_begin, from.steps_end,
          rounded<T>(from.p_ZoPo_Z)};
}

template <typename T>
AppliedOutside<T> rounded(const AppliedOutside<Real>& from) {
  return {from.body, from.in_root_axes, rounded<T>(from.R_ZL), rounded<T>(from.p_ZoA_Z),
          rounded<T>(from.given)};
}

template <typename T>
ActuatorTerms<T> rounded(const ActuatorTerms<Real>& from) {
  return {from.coordinate,      T(from.multiplier),    T(from.offset),
          T(from.stiffness),    T(from.damping),       T(from.coulomb),
          T(from.per_velocity), T(from.rotor_inertia), T(from.constant)};
}

template <typename T, template <typename> class Item>
std::vector<Item<T>> roundedAll(const std::vector<Item<Real>>& from) {
  std::vector<Item<T>> items;
  for (const Item<Real>& item : from) items.push_back(rounded<T>(item));
  return items;
}

}  // namespace

template <typename T>
Plan<T> roundPlan(const Plan<Real>& from) {
  Plan<T> plan;
  static_cast<PlanUse&>(plan) = from;
  plan.root_wrench = rounded<T>(from.root_wrench);
  plan.bodies = roundedAll<T>(from.bodies);
  plan.angles = roundedAll<T>(from.angles);
  plan.slides = roundedAll<T>(from.slides);
  plan.child_axes = roundedAll<T>(from.child_axes);
  plan.root_axes = roundedAll<T>(from.root_axes);
  plan.moved = roundedAll<T>(from.moved);
  plan.applied = roundedAll<T>(from.applied);
  plan.actuators = roundedAll<T>(from.actuators);
  return plan;
}

template <typename T>
PlanView<T> viewOf(const Plan<T>& plan) {
  PlanView<T> view;
  view.bodies = plan.bodies.data();
  view.angles = plan.angles.data();
  view.slides = plan.slides.data();
  view.child_axes = plan.child_axes.data();
  view.root_axes = plan.root_axes.data();
  view.moved = plan.moved.data();
  view.point_steps = plan.point_steps.data();
  view.applied = plan.applied.data();
  view.actuators = plan.actuators.data();
  view.carries = plan.carries.data();
  view.zero_efforts = plan.zero_efforts.data();
  view.body_count = static_cast<int>(plan.bodies.size());
  view.angle_count = static_cast<int>(plan.angles.size());
  view.slide_count = static_cast<int>(plan.slides.size());
  view.child_axes_count = static_cast<int>(plan.child_axes.size());
  view.root_axes_count = static_cast<int>(plan.root_axes.size());
  view.moved_count = static_cast<int>(plan.moved.size());
  view.applied_count = static_cast<int>(plan.applied.size());
  view.actuator_count = static_cast<int>(plan.actuators.size());
  view.zero_effort_count = static_cast<int>(plan.zero_efforts.size());
  view.slots = plan.slots;
  view.wrench_count = plan.wrenches;
  view.static_motion = plan.static_motion;
  view.root_moves = plan.root_moves;
  view.any_pose = plan.any_pose;
  view.child_zeros = plan.child_zeros;
  view.root_zeros = plan.root_zeros;
  view.geared_angles = plan.geared_angles;
  view.root_wrench = plan.root_wrench;
  return view;
}

template Plan<float> roundPlan<float>(const Plan<Real>&);
template Plan<double> roundPlan<double>(const Plan<Real>&);
template PlanView<float> viewOf<float>(const Plan<float>&);
template PlanView<double> viewOf<double>(const Plan<double>&);
template PlanView<Real> viewOf<Real>(const Plan<Real>&);

}  // namespace virtual_work_dynamics
