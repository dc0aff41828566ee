#pragma once

#include "core/kernel/poses.h"
#include "core/kernel/recursion.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// Memory of one evaluation; the arrays are as long as the plan's lists.
template <typename T, typename R>
struct Scratch {
  T* cosines;                ///< of Plan::angles
  T* sines;                  ///<
  T* slides;                 ///< positions of Plan::slides
  PlainWrench<T>* wrenches;  ///< of the bodies, in Z axes and about O_k
  BodyMotion<T>* slots;      ///< motions that later children need
  BodyPose<T>* poses;        ///< of the bodies that need one; [0] is the root's
  T* angles;                 ///< see sampleAngles()
  R* phase_cos;              ///<
  R* phase_sin;              ///<
};

template <typename T, typename R>
VWD_INLINE T coordinateOf(const R* values, std::size_t stride, int coordinate, bool geared,
                          const R& multiplier) {
  const T value = load<T>(values + static_cast<std::size_t>(coordinate) * stride);
  return geared ? multiplier * value : value;
}

template <typename T, typename R>
VWD_INLINE T positionOf(const JointPosition<R>& joint, const KernelInputs<R>& in) {
  const T q = load<T>(in.q + static_cast<std::size_t>(joint.coordinate) * in.stride);
  return joint.geared ? mulAdd(joint.multiplier, q, T(joint.offset)) : q;
}

template <typename T, typename R>
VWD_INLINE void slidePositions(const PlanView<R>& plan, const KernelInputs<R>& in,
                               const Scratch<T, R>& scratch) {
  for (int i = 0; i < plan.slide_count; ++i) {
    scratch.slides[i] = positionOf<T>(plan.slides[i], in);
  }
}

template <bool kStatic, typename T, typename R>
VWD_INLINE JointMotion<T> jointMotion(const Body<R>& body, const KernelInputs<R>& in,
                                      const Scratch<T, R>& scratch) {
  JointMotion<T> joint;
  if (body.angle >= 0) joint.Rz = {scratch.cosines[body.angle], scratch.sines[body.angle]};
  if (body.slide >= 0) joint.slide = scratch.slides[body.slide];
  if (!kStatic && body.coordinate >= 0) {
    joint.qd = coordinateOf<T>(in.qd, in.stride, body.coordinate, body.geared, body.multiplier);
    joint.qdd = coordinateOf<T>(in.qdd, in.stride, body.coordinate, body.geared, body.multiplier);
  }
  return joint;
}

template <typename T, typename R>
VWD_INLINE PlainWrench<T> constantWrench(const PlainWrench<R>& wrench) {
  return {{T(wrench.force.x), T(wrench.force.y), T(wrench.force.z)},
          {T(wrench.torque.x), T(wrench.torque.y), T(wrench.torque.z)}};
}

/// Root to leaves: motions (2.5)-(2.7) and the wrenches (3.5) of the single bodies.
template <bool kStatic, typename T, typename R>
VWD_INLINE void sweepOut(const PlanView<R>& plan, const KernelInputs<R>& in,
                         const Scratch<T, R>& scratch) {
  const PlainWrench<T> none = constantWrench<T>(PlainWrench<R>{});
  scratch.wrenches[0] = constantWrench<T>(plan.root_wrench);
  BodyMotion<T> motion{};
  for (int k = 1; k < plan.body_count; ++k) {
    const Body<R>& body = plan.bodies[k];
    if (!body.has_inertia && body.wrench_needed) scratch.wrenches[k] = none;
    if (!body.motion_needed) continue;
    const JointMotion<T> joint = jointMotion<kStatic>(body, in, scratch);
    if (body.parent_rests) {
      startMotion<kStatic>(body, joint, motion);
    } else {
      if (body.parent_slot >= 0) motion = scratch.slots[body.parent_slot];
      propagateMotion<kStatic>(body, joint, motion);
    }
    if (body.own_slot >= 0) scratch.slots[body.own_slot] = motion;
    if (!body.has_inertia) continue;
    scratch.wrenches[k] = body.parent_rests ? startWrench<kStatic>(body, motion)
                                            : inertiaWrench<kStatic>(body, motion);
  }
}

/// -f*, -m* of (3.8) for the applied wrenches.
template <typename T, typename R>
VWD_INLINE void subtractApplied(const PlanView<R>& plan, const KernelInputs<R>& in,
                                const Scratch<T, R>& scratch) {
  for (int i = 0; i < plan.applied_count; ++i) {
    const AppliedOutside<R>& where = plan.applied[i];
    if (where.body < 0) continue;
    PlainWrench<T> applied = constantWrench<T>(in.applied[i]);
    if (where.in_root_axes) {
      const Mat3<T>& R_0Z = scratch.poses[where.body].R_0Z;
      applied.force = transposeTimes(R_0Z, applied.force);
      applied.torque = addCross(transposeTimes(R_0Z, applied.torque), where.p_ZoA_Z, applied.force);
    }
    PlainWrench<T>& wrench = scratch.wrenches[where.body];
    wrench = {wrench.force - applied.force, wrench.torque - applied.torque};
  }
}

template <typename T>
VWD_INLINE void dropActive(Mobility mobility, PlainWrench<T>& wrench) {
  if (mobility == Mobility::kRevolute) wrench.torque.z = T(0);
  if (mobility == Mobility::kPrismatic) wrench.force.z = T(0);
}

/// A reported wrench in the axes of R_KZ, as six numbers.
template <typename T, typename R>
VWD_INLINE void storeWrench(const ReactionOutput<R>& output, PlainWrench<T> wrench,
                            Mobility mobility, R* to, std::size_t stride) {
  if (output.drop_active) dropActive(mobility, wrench);
  if (output.permutes) {
    R* const torque = to + 3 * stride;
    const std::size_t x = static_cast<std::size_t>(output.row[0]) * stride;
    const std::size_t y = static_cast<std::size_t>(output.row[1]) * stride;
    const std::size_t z = static_cast<std::size_t>(output.row[2]) * stride;
    store(to + x, output.sign[0] * wrench.force.x);
    store(to + y, output.sign[1] * wrench.force.y);
    store(to + z, output.sign[2] * wrench.force.z);
    store(torque + x, output.sign[0] * wrench.torque.x);
    store(torque + y, output.sign[1] * wrench.torque.y);
    store(torque + z, output.sign[2] * wrench.torque.z);
    return;
  }
  storeVector(times(output.R_KZ, wrench.force), to, stride);
  storeVector(times(output.R_KZ, wrench.torque), to + 3 * stride, stride);
}

template <typename T, typename R>
VWD_INLINE void storeZeros(R* to, std::size_t count, std::size_t stride) {
  for (std::size_t i = 0; i < count; ++i) store(to + i * stride, T(0));
}

/// (3.7): the component along the joint axis, summed over the joints that a coordinate moves.
template <typename T, typename R>
VWD_INLINE void addEffort(const Body<R>& body, const PlainWrench<T>& wrench,
                          const KernelOutputs<R>& out) {
  R* const to = out.effort + static_cast<std::size_t>(body.coordinate) * out.stride;
  T active = body.mobility == Mobility::kPrismatic ? wrench.force.z : wrench.torque.z;
  if (body.geared) active = body.multiplier * active;
  store(to, body.summed ? load<T>(to) + active : active);
}

/// Leaves to root: (3.8), and what is reported of it in Z axes or the child link's.
template <typename T, typename R>
VWD_INLINE void sweepIn(const PlanView<R>& plan, const KernelInputs<R>& in,
                        const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  PlainWrench<T> handed{};
  for (int k = plan.body_count - 1; k >= 0; --k) {
    const Body<R>& body = plan.bodies[k];
    if (!body.wrench_needed) continue;
    PlainWrench<T> wrench = scratch.wrenches[k];
    if (body.takes_from_next) {
      wrench = {wrench.force + handed.force, wrench.torque + handed.torque};
    }
    if (body.drives && out.effort) addEffort(body, wrench, out);
    if (body.child_axes >= 0 && out.child_axes) {
      storeWrench(plan.child_axes[body.child_axes], wrench, body.mobility,
                  out.child_axes + 6 * static_cast<std::size_t>(body.child_axes) * out.stride,
                  out.stride);
    }
    if (body.wrench_outlives) scratch.wrenches[k] = wrench;
    if (!body.hands_on && !body.adds_to_parent) continue;
    handed = toParent(body, jointMotion<true>(body, in, scratch), wrench);
    if (body.adds_to_parent) {
      PlainWrench<T>& parent = scratch.wrenches[body.parent];
      parent = {parent.force + handed.force, parent.torque + handed.torque};
    }
  }
}

/// What is known to be zero.
template <typename T, typename R>
VWD_INLINE void storeKnownZeros(const PlanView<R>& plan, const KernelOutputs<R>& out) {
  if (out.effort) {
    for (int i = 0; i < plan.zero_effort_count; ++i) {
      storeZeros<T>(out.effort + static_cast<std::size_t>(plan.zero_efforts[i]) * out.stride, 1,
                    out.stride);
    }
  }
  for (int i = 0; out.child_axes && i < plan.child_axes_count; ++i) {
    if (plan.child_axes[i].body >= 0) continue;
    storeZeros<T>(out.child_axes + 6 * static_cast<std::size_t>(i) * out.stride, 6, out.stride);
  }
}

/// Poses of the bodies that need one; velocities where they are asked for.
template <bool kStatic, typename T, typename R>
VWD_INLINE void sweepPoses(const PlanView<R>& plan, const KernelInputs<R>& in,
                           const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  for (int k = 1; k < plan.body_count; ++k) {
    const Body<R>& body = plan.bodies[k];
    if (!body.pose_needed) continue;
    const BodyPose<T>& parent = scratch.poses[body.parent];
    if (out.twists) {
      JointMotion<T> joint = jointMotion<kStatic>(body, in, scratch);
      if (kStatic) joint.qd = T(0);
      scratch.poses[k] = propagatePose<true>(body, joint, parent);
    } else {
      scratch.poses[k] = propagatePose<false>(body, jointMotion<true>(body, in, scratch), parent);
    }
  }
}

/// (4.3): reactions, poses and twists in root axes.
template <typename T, typename R>
VWD_INLINE void storeRootAxes(const PlanView<R>& plan, const KernelOutputs<R>& out,
                              const Scratch<T, R>& scratch) {
  for (int i = 0; i < plan.root_axes_count; ++i) {
    const ReactionOutput<R>& output = plan.root_axes[i];
    const std::size_t index = static_cast<std::size_t>(i);
    if (output.body < 0) {
      if (out.root_axes) storeZeros<T>(out.root_axes + 6 * index * out.stride, 6, out.stride);
      continue;
    }
    const BodyPose<T>& pose = scratch.poses[output.body];
    if (out.root_axes) {
      R* const to = out.root_axes + 6 * index * out.stride;
      const Body<R>& body = plan.bodies[output.body];
      if (body.wrench_needed) {
        PlainWrench<T> wrench = scratch.wrenches[output.body];
        if (output.drop_active) dropActive(body.mobility, wrench);
        storeVector(times(pose.R_0Z, wrench.force), to, out.stride);
        storeVector(times(pose.R_0Z, wrench.torque), to + 3 * out.stride, out.stride);
      } else {
        storeZeros<T>(to, 6, out.stride);
      }
    }
    if (out.poses) storePose(output, pose, out.poses + 12 * index * out.stride, out.stride);
    if (out.twists) {
      storeVector(pose.v_0, out.twists + 6 * index * out.stride, out.stride);
      storeVector(pose.w_0, out.twists + (6 * index + 3) * out.stride, out.stride);
    }
  }
}

template <bool kStatic, typename T, typename R>
VWD_INLINE void sweepAll(const PlanView<R>& plan, const KernelInputs<R>& in,
                         const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  slidePositions(plan, in, scratch);
  sweepOut<kStatic>(plan, in, scratch);
  if (plan.any_pose) sweepPoses<kStatic>(plan, in, out, scratch);
  subtractApplied(plan, in, scratch);
  sweepIn(plan, in, out, scratch);
  storeKnownZeros<T>(plan, out);
  storeRootAxes(plan, out, scratch);
}

/// One evaluation, once the cosines and sines of the joints are in the scratch memory.
template <typename T, typename R>
VWD_INLINE void evaluate(const PlanView<R>& plan, const KernelInputs<R>& in,
                         const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  if (plan.static_motion) {
    sweepAll<true>(plan, in, out, scratch);
  } else {
    sweepAll<false>(plan, in, out, scratch);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
