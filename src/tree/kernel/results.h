#pragma once

#include "tree/kernel/joint_motion.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

// What the sweeps report.

/// Takes from a wrench what actuators deliver, see ActivePart.
template <typename T, typename R>
VWD_INLINE void dropActive(const ReactionOutput<R>& output, const Body<R>& body,
                           const KernelInputs<R>& in, const Scratch<T, R>& scratch,
                           PlainWrench<T>& wrench) {
  const T zero = T(0);
  switch (output.active) {
    case ActivePart::kAxis:
      if (body.mobility == Mobility::kRevolute) wrench.torque.z = zero;
      if (body.mobility == Mobility::kPrismatic) wrench.force.z = zero;
      return;
    case ActivePart::kPlane:
      wrench = {{zero, zero, wrench.force.z}, {wrench.torque.x, wrench.torque.y, zero}};
      return;
    case ActivePart::kCylinder:
      wrench.force.z = wrench.torque.z = zero;
      return;
    case ActivePart::kScrew:
      wrench.torque.z = -output.pitch * wrench.force.z;
      return;
    case ActivePart::kBall:
      wrench.torque = {zero, zero, zero};
      return;
    case ActivePart::kAll:
      wrench = {{zero, zero, zero}, {zero, zero, zero}};
      return;
    case ActivePart::kCross:
      break;
  }
  const JointMotion<T> joint = jointMotion<true, false>(body, in, scratch);
  Vec3<T> normal = {T(output.normal_P.x), T(output.normal_P.y), T(output.normal_P.z)};
  forAxis(body.axis,
          [&](auto axis) VWD_LAMBDA { normal = toChild<axis.value>(body.R_PZ, normal); });
  normal = transposeTimes(joint.Rz, normal);
  const T along = mulAdd(normal.x, wrench.torque.x,
                         mulAdd(normal.y, wrench.torque.y, normal.z * wrench.torque.z));
  wrench.torque = {along * normal.x, along * normal.y, along * normal.z};
}

template <typename T, typename R>
VWD_INLINE Vec3<T> flipped(const ReactionOutput<R>& output, const Vec3<T>& v) {
  return {output.sign[0] * v.x, output.sign[1] * v.y, output.sign[2] * v.z};
}

/// A reported wrench in the axes of R_KZ, as six numbers.
template <typename T, typename R>
VWD_INLINE void storeWrench(const ReactionOutput<R>& output, PlainWrench<T> wrench, R* to,
                            std::size_t stride) {
  if (output.permutes) {
    if (output.flips) {
      wrench.force = flipped(output, wrench.force);
      wrench.torque = flipped(output, wrench.torque);
    }
    R* const torque = to + 3 * stride;
    const std::size_t x = static_cast<std::size_t>(output.row[0]) * stride;
    const std::size_t y = static_cast<std::size_t>(output.row[1]) * stride;
    const std::size_t z = static_cast<std::size_t>(output.row[2]) * stride;
    store(to + x, wrench.force.x);
    store(to + y, wrench.force.y);
    store(to + z, wrench.force.z);
    store(torque + x, wrench.torque.x);
    store(torque + y, wrench.torque.y);
    store(torque + z, wrench.torque.z);
    return;
  }
  storeVector(times(output.R_KZ, wrench.force), to, stride);
  storeVector(times(output.R_KZ, wrench.torque), to + 3 * stride, stride);
}

template <typename T, typename R>
VWD_INLINE void storeZeros(R* to, std::size_t count, std::size_t stride) {
  for (std::size_t i = 0; i < count; ++i) store(to + i * stride, T(0));
}

/// Adds the component along the joint axis, (3.7), summed over the joints that a coordinate moves.
template <typename T, typename R>
VWD_INLINE void addEffort(const Body<R>& body, const PlainWrench<T>& wrench,
                          const KernelOutputs<R>& out) {
  R* const to = out.effort + static_cast<std::size_t>(body.coordinate) * out.stride;
  T active = body.mobility == Mobility::kPrismatic ? wrench.force.z : wrench.torque.z;  // (3.7)
  if (body.geared) active = body.multiplier * active;
  store(to, body.summed ? load<T>(to) + active : active);
}

/// Writes a body's reaction in the axes of the child link. kPlain: see PlainReport.
template <bool kPlain, typename T, typename R>
VWD_INLINE void storeChildAxes(const PlanView<R>& plan, const Body<R>& body,
                               const KernelInputs<R>& in, const KernelOutputs<R>& out,
                               const Scratch<T, R>& scratch, const PlainWrench<T>& wrench) {
  const ReactionOutput<R>& output = plan.child_axes[body.child_axes];
  R* const to = out.child_axes + 6 * static_cast<std::size_t>(body.child_axes) * out.stride;
  if (!kPlain && output.drop_active) {
    PlainWrench<T> borne = wrench;
    dropActive(output, body, in, scratch, borne);
    storeWrench(output, borne, to, out.stride);
  } else {
    storeWrench(output, wrench, to, out.stride);
  }
}

/// Writes a wrench, turned into root axes, (4.3).
template <typename T, typename R>
VWD_INLINE void storeTurned(const Mat3<T>& R_0, const PlainWrench<T>& wrench, R* to,
                            std::size_t stride) {
  storeVector(times(R_0, wrench.force), to, stride);
  storeVector(times(R_0, wrench.torque), to + 3 * stride, stride);
}

template <typename T, typename R>
VWD_INLINE void storeAsItIs(const PlainWrench<T>& wrench, R* to, std::size_t stride) {
  storeVector(wrench.force, to, stride);
  storeVector(wrench.torque, to + 3 * stride, stride);
}

/// Writes a body's reaction in root axes, of its wrench in its parent's axes.
template <typename T, typename R>
VWD_INLINE void storeByParent(const Body<R>& body, const KernelOutputs<R>& out,
                              const Scratch<T, R>& scratch, const PlainWrench<T>& wrench) {
  R* const to = out.root_axes + 6 * static_cast<std::size_t>(body.root_axes) * out.stride;
  if (body.parent > 0) {
    storeTurned(scratch.poses[body.parent].R_0Z, wrench, to, out.stride);
  } else {
    storeAsItIs(wrench, to, out.stride);
  }
}

/// Writes the reaction of a body in root axes, of its wrench in its own axes.
template <typename T, typename R>
VWD_INLINE void storeRootAxes(const PlanView<R>& plan, int k, const KernelInputs<R>& in,
                              const KernelOutputs<R>& out, const Scratch<T, R>& scratch,
                              const PlainWrench<T>& wrench) {
  const Body<R>& body = plan.bodies[k];
  const ReactionOutput<R>& output = plan.root_axes[body.root_axes];
  R* const to = out.root_axes + 6 * static_cast<std::size_t>(body.root_axes) * out.stride;
  if (k == 0) return storeAsItIs(wrench, to, out.stride);
  PlainWrench<T> borne = wrench;
  dropActive(output, body, in, scratch, borne);
  storeTurned(scratch.poses[k].R_0Z, borne, to, out.stride);
}

/// Writes poses and twists, which are in root axes.
template <typename T, typename R>
VWD_INLINE void storePoses(const PlanView<R>& plan, const KernelOutputs<R>& out,
                           const Scratch<T, R>& scratch) {
  for (int i = 0; i < plan.root_axes_count; ++i) {
    const ReactionOutput<R>& output = plan.root_axes[i];
    const std::size_t index = static_cast<std::size_t>(i);
    if (output.body < 0) continue;
    const BodyPose<T>& pose = scratch.poses[output.body];
    if (out.poses) storePose(output, pose, out.poses + 12 * index * out.stride, out.stride);
    if (out.twists) {
      storeVector(pose.v_0, out.twists + 6 * index * out.stride, out.stride);
      storeVector(pose.w_0, out.twists + (6 * index + 3) * out.stride, out.stride);
    }
  }
}

/// Writes zeros where results are known to be zero.
template <typename T, typename R>
VWD_INLINE void storeKnownZeros(const PlanView<R>& plan, const KernelOutputs<R>& out) {
  if (out.effort) {
    for (int i = 0; i < plan.zero_effort_count; ++i) {
      storeZeros<T>(out.effort + static_cast<std::size_t>(plan.zero_efforts[i]) * out.stride, 1,
                    out.stride);
    }
  }
  for (int i = 0; plan.child_zeros && out.child_axes && i < plan.child_axes_count; ++i) {
    if (plan.child_axes[i].body >= 0) continue;
    storeZeros<T>(out.child_axes + 6 * static_cast<std::size_t>(i) * out.stride, 6, out.stride);
  }
  for (int i = 0; plan.root_zeros && out.root_axes && i < plan.root_axes_count; ++i) {
    const int body = plan.root_axes[i].body;
    if (body >= 0 && plan.bodies[body].wrench_needed) continue;
    storeZeros<T>(out.root_axes + 6 * static_cast<std::size_t>(i) * out.stride, 6, out.stride);
  }
}

/// Adds to the efforts what the joints' terms demand.
template <bool kStatic, typename T, typename R>
VWD_INLINE void addActuators(const PlanView<R>& plan, const KernelInputs<R>& in,
                             const KernelOutputs<R>& out) {
  for (int i = 0; i < plan.actuator_count; ++i) {
    const ActuatorTerms<R>& joint = plan.actuators[i];
    const std::size_t at = static_cast<std::size_t>(joint.coordinate);
    const T q = load<T>(in.q + at * in.stride);
    const T stretch = mulAdd(joint.multiplier, q, T(joint.offset));
    T sum = mulAdd(joint.stiffness, stretch, T(joint.constant));
    if (!kStatic) {
      const T rate = joint.multiplier * load<T>(in.qd + at * in.stride);
      const T acceleration = joint.multiplier * load<T>(in.qdd + at * in.stride);
      const T s = heldWithinOne(joint.per_velocity * rate);
      const T half = R(0.5) * s;
      sum = mulAdd(joint.coulomb, mulAdd(half, T(R(1)) - s * s, s), sum);
      sum = mulAdd(joint.damping, rate, mulAdd(joint.rotor_inertia, acceleration, sum));
    }
    R* const to = out.effort + at * out.stride;
    store(to, mulAdd(joint.multiplier, sum, load<T>(to)));
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
