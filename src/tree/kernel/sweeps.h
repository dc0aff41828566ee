#pragma once

#include "tree/kernel/moved_moments.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

template <typename T, typename R>
VWD_INLINE PlainWrench<T> constantWrench(const PlainWrench<R>& wrench) {
  return {{T(wrench.force.x), T(wrench.force.y), T(wrench.force.z)},
          {T(wrench.torque.x), T(wrench.torque.y), T(wrench.torque.z)}};
}

/// Makes `arrival` that of the next body of sweepOut(), where that one is reached from this one.
template <bool kStatic, typename T, typename R>
VWD_INLINE void feedNext(const PlanView<R>& plan, const Body<R>& body, const Scratch<T, R>& scratch,
                         const BodyMotion<T>& motion, Arrival<T>& arrival) {
  if (body.feeds > 0) {
    arriveAt<kStatic>(plan.bodies[body.feeds], scratch.slides, motion, arrival);
  }
}

/// Moves a body of sweepOut() that is plain.
template <bool kStatic, AxisDirection kAxis, typename T, typename R>
VWD_INLINE void movePlainBody(const PlanView<R>& plan, const Body<R>& body,
                              const KernelInputs<R>& in, const Scratch<T, R>& scratch,
                              Arrival<T>& arrival, PlainWrench<T>& wrench) {
  BodyMotion<T> motion;
  propagateMotion<kStatic, true, kAxis>(body, in, jointMotion<kStatic, true>(body, in, scratch),
                                        arrival, motion);
  wrench = inertiaWrench<kStatic>(body, motion);
  feedNext<kStatic>(plan, body, scratch, motion, arrival);
}

/// Moves a body of sweepOut() that is on a parent at rest.
template <bool kStatic, typename T, typename R>
VWD_INLINE void startBody(const PlanView<R>& plan, const Body<R>& body, const KernelInputs<R>& in,
                          const Scratch<T, R>& scratch, Arrival<T>& arrival,
                          PlainWrench<T>& wrench) {
  BodyMotion<T> motion;
  startMotion<kStatic>(body, in, jointMotion<kStatic, false>(body, in, scratch), motion);
  if (body.has_inertia) wrench = startWrench<kStatic>(body, motion);
  if (body.own_slot >= 0) scratch.slots[body.own_slot] = motion;
  feedNext<kStatic>(plan, body, scratch, motion, arrival);
}

/// Moves any other body of sweepOut().
template <bool kStatic, typename T, typename R>
VWD_INLINE void moveBody(const PlanView<R>& plan, const Body<R>& body, const KernelInputs<R>& in,
                         const Scratch<T, R>& scratch, Arrival<T>& arrival,
                         PlainWrench<T>& wrench) {
  if (body.parent_slot >= 0) {
    arriveAt<kStatic>(body, scratch.slides, scratch.slots[body.parent_slot], arrival);
  }
  BodyMotion<T> motion;
  const JointMotion<T> joint = jointMotion<kStatic, false>(body, in, scratch);
  forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
    propagateMotion<kStatic, false, axis.value>(body, in, joint, arrival, motion);
  });
  if (body.has_inertia) wrench = inertiaWrench<kStatic>(body, motion);
  if (body.own_slot >= 0) scratch.slots[body.own_slot] = motion;
  feedNext<kStatic>(plan, body, scratch, motion, arrival);
}

/// Moves the root as the motion says, and starts sweepOut() from it.
template <bool kStatic, typename T, typename R>
VWD_INLINE void moveRoot(const PlanView<R>& plan, const KernelInputs<R>& in,
                         const Scratch<T, R>& scratch, Arrival<T>& arrival) {
  const Body<R>& root = plan.bodies[0];
  BodyMotion<T> motion;
  motion.gamma = loadVector<T>(in.root + 6 * in.root_stride, in.root_stride);
  if (!kStatic) {
    motion.w = loadVector<T>(in.root, in.root_stride);
    motion.alpha = loadVector<T>(in.root + 3 * in.root_stride, in.root_stride);
    motion.U = accelerationGradient(motion.w, motion.alpha);
  }
  if (root.has_inertia) scratch.wrenches[0] = inertiaWrench<kStatic>(root, motion);
  if (root.own_slot >= 0) scratch.slots[root.own_slot] = motion;
  feedNext<kStatic>(plan, root, scratch, motion, arrival);
}

/// Root to leaves: motions (2.5)-(2.7) and the wrenches (3.5) of the single bodies.
template <bool kStatic, typename T, typename R>
VWD_INLINE void sweepOut(const PlanView<R>& plan, const KernelInputs<R>& in,
                         const Scratch<T, R>& scratch) {
  scratch.wrenches[0] = constantWrench<T>(plan.root_wrench);
  Arrival<T> arrival;
  if (plan.root_moves) moveRoot<kStatic>(plan, in, scratch, arrival);
  for (int k = 1; k < plan.body_count; ++k) {
    const Body<R>& body = plan.bodies[k];
    PlainWrench<T>& wrench = scratch.wrenches[k];
    if (body.plain_motion) {
      forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
        movePlainBody<kStatic, axis.value>(plan, body, in, scratch, arrival, wrench);
      });
      continue;
    }
    if (!body.has_inertia && body.wrench_needed) wrench = constantWrench<T>(PlainWrench<R>{});
    if (!body.motion_needed) continue;
    if (body.parent_rests) {
      startBody<kStatic>(plan, body, in, scratch, arrival, wrench);
    } else {
      moveBody<kStatic>(plan, body, in, scratch, arrival, wrench);
    }
  }
}

/// Subtracts the applied wrenches: -f* and -m* of (3.8).
template <typename T, typename R>
VWD_INLINE void subtractApplied(const PlanView<R>& plan, const KernelInputs<R>& in,
                                const Scratch<T, R>& scratch) {
  for (int i = 0; i < plan.applied_count; ++i) {
    const AppliedOutside<R>& where = plan.applied[i];
    if (where.body < 0) continue;
    const R* const from = in.applied + 6 * static_cast<std::size_t>(i) * in.applied_stride;
    PlainWrench<T> applied{loadVector<T>(from, in.applied_stride),
                           loadVector<T>(from + 3 * in.applied_stride, in.applied_stride)};
    if (where.in_root_axes) {
      const Mat3<T>& R_0Z = scratch.poses[where.body].R_0Z;
      applied.force = transposeTimes(R_0Z, applied.force);
      applied.torque = addCross(transposeTimes(R_0Z, applied.torque), where.p_ZoA_Z, applied.force);
    }
    PlainWrench<T>& wrench = scratch.wrenches[where.body];
    wrench = {wrench.force - applied.force, wrench.torque - applied.torque};  // (3.8), - f*, - m*
  }
}

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

template <typename T>
VWD_INLINE void addTo(PlainWrench<T>& sum, bool starts, const PlainWrench<T>& wrench) {
  if (starts) {
    sum = wrench;
  } else {
    sum = {sum.force + wrench.force, sum.torque + wrench.torque};
  }
}

// Departs from (3.8): the print is of a serial chain; in a tree it is a sum over all children.

/// Adds a child's wrench to the sum over children, or to a partial sum of them.
template <typename T, typename R>
VWD_INLINE void sumUp(const PlanView<R>& plan, const Body<R>& body, const PlainWrench<T>& handed,
                      PlainWrench<T>* wrenches) {
  addTo(wrenches[body.sums_into], body.starts_sum, handed);
  for (int i = body.carries_begin; i < body.carries_end; ++i) {
    const Carry& carry = plan.carries[i];
    addTo(wrenches[carry.to], carry.starts, wrenches[carry.from]);
  }
}

/// Leaves to root: (3.8), and what is reported of it in Z axes or the child link's.
template <typename T, typename R>
VWD_INLINE void sweepIn(const PlanView<R>& plan, const KernelInputs<R>& in,
                        const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  PlainWrench<T> handed{};
  for (int k = plan.body_count - 1; k >= 0; --k) {
    const Body<R>& body = plan.bodies[k];
    if (!body.wrench_needed) continue;
    const PlainWrench<T>& own = scratch.wrenches[k];
    PlainWrench<T> wrench;
    if (body.takes_from_next) {
      wrench = {own.force + handed.force, own.torque + handed.torque};  // (3.8)
    } else {
      wrench = {{own.force.x, own.force.y, own.force.z},
                {own.torque.x, own.torque.y, own.torque.z}};
    }
    if (body.plain_wrench) {
      if (out.effort) {
        // (3.7), u3^T M
        store(out.effort + static_cast<std::size_t>(body.coordinate) * out.stride, wrench.torque.z);
      }
    } else if (body.drives && out.effort) {
      addEffort(body, wrench, out);
    }
    if (body.child_axes >= 0 && out.child_axes) {
      const ReactionOutput<R>& output = plan.child_axes[body.child_axes];
      R* const to = out.child_axes + 6 * static_cast<std::size_t>(body.child_axes) * out.stride;
      if (output.drop_active) {
        PlainWrench<T> borne = wrench;
        dropActive(output, body, in, scratch, borne);
        storeWrench(output, borne, to, out.stride);
      } else {
        storeWrench(output, wrench, to, out.stride);
      }
    }
    if (body.plain_wrench) {
      const JointMotion<T> joint = jointMotion<true, true>(body, in, scratch);
      forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
        handed = toParent<true, axis.value>(body, in, joint, wrench);
      });
      continue;
    }
    if (body.wrench_outlives) scratch.wrenches[k] = wrench;
    if (!body.hands_on && !body.adds_to_parent) continue;
    const JointMotion<T> joint = jointMotion<true, false>(body, in, scratch);
    forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
      handed = toParent<false, axis.value>(body, in, joint, wrench);
    });
    if (body.adds_to_parent) sumUp(plan, body, handed, scratch.wrenches);
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
  for (int i = 0; out.child_axes && i < plan.child_axes_count; ++i) {
    if (plan.child_axes[i].body >= 0) continue;
    storeZeros<T>(out.child_axes + 6 * static_cast<std::size_t>(i) * out.stride, 6, out.stride);
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

/// Finds the poses of the bodies that need one, and velocities where they are asked for.
template <bool kStatic, typename T, typename R>
VWD_INLINE void sweepPoses(const PlanView<R>& plan, const KernelInputs<R>& in,
                           const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  for (int k = 1; k < plan.body_count; ++k) {
    const Body<R>& body = plan.bodies[k];
    if (!body.pose_needed) continue;
    const BodyPose<T>& parent = scratch.poses[body.parent];
    BodyPose<T>& pose = scratch.poses[k];
    JointMotion<T> joint = jointMotion<kStatic, false>(body, in, scratch);
    if (out.twists) {
      if (kStatic) joint.qd = T(0);
      propagatePose<PoseExtent::kTwist>(body, in, joint, parent, pose);
    } else if (out.poses) {
      propagatePose<PoseExtent::kPosition>(body, in, joint, parent, pose);
    } else {
      propagatePose<PoseExtent::kRotation>(body, in, joint, parent, pose);
    }
  }
}

/// Writes reactions (4.3), poses and twists in root axes.
template <typename T, typename R>
VWD_INLINE void storeRootAxes(const PlanView<R>& plan, const KernelInputs<R>& in,
                              const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
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
        if (output.drop_active) dropActive(output, body, in, scratch, wrench);
        storeVector(times(pose.R_0Z, wrench.force), to, out.stride);  // (4.3)
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
  if (out.effort) addActuators<kStatic, T>(plan, in, out);
  storeRootAxes(plan, in, out, scratch);
  if (plan.moved_count > 0) moveMoments(plan, in, out, scratch);
}

/// Evaluates one sample, once the cosines and sines of the joints are in the scratch memory.
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
