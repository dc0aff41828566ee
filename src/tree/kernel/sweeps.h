#pragma once

#include "tree/kernel/moved_moments.h"
#include "tree/kernel/results.h"

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

/// Moves a body of sweepOut() that is plain. kTurned: see BodyUse::turned_motion.
template <bool kStatic, bool kTurned, AxisDirection kAxis, typename T, typename R>
VWD_INLINE void movePlainBody(const PlanView<R>& plan, int k, const KernelInputs<R>& in,
                              const Scratch<T, R>& scratch, Arrival<T>& arrival) {
  const Body<R>& body = plan.bodies[k];
  PlainWrench<T>& wrench = scratch.wrenches[k];
  const JointMotion<T> joint = jointMotion<kStatic, true>(body, in, scratch);
  if (kTurned) {
    const Mat3<T>& R_0P = scratch.poses[body.parent].R_0Z;
    scratch.poses[k].R_0Z = times(unturnedRotation<kAxis>(body, R_0P), joint.Rz);
  }
  BodyMotion<T> motion;
  propagateMotion<kStatic, true, kAxis>(body, in, joint, arrival, motion);
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

/// Finds the rotation of any other body of sweepOut() in root axes.
template <typename T, typename R>
VWD_INLINE void turnBody(const PlanView<R>& plan, int k, const KernelInputs<R>& in,
                         const Scratch<T, R>& scratch) {
  const Body<R>& body = plan.bodies[k];
  const JointMotion<T> joint = jointMotion<true, false>(body, in, scratch);
  Mat3<T>& R_0Z = scratch.poses[k].R_0Z;
  if (body.parent == 0) {
    const Mat3<R>& A = body.R_PZ;
    R_0Z = {T(A.xx), T(A.xy), T(A.xz), T(A.yx), T(A.yy), T(A.yz), T(A.zx), T(A.zy), T(A.zz)};
    R_0Z = turnedByJoint(body, in, joint.Rz, R_0Z);
    return;
  }
  const Mat3<T>& R_0P = scratch.poses[body.parent].R_0Z;
  forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
    R_0Z = turnedByJoint(body, in, joint.Rz, unturnedRotation<axis.value>(body, R_0P));
  });
}

/// Root to leaves: rotations in root axes where they are needed, motions (2.5)-(2.7) and the
/// wrenches (3.5) of the single bodies.
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
        movePlainBody<kStatic, false, axis.value>(plan, k, in, scratch, arrival);
      });
      continue;
    }
    if (body.turned_motion) {
      forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
        movePlainBody<kStatic, true, axis.value>(plan, k, in, scratch, arrival);
      });
      continue;
    }
    if (VWD_SELDOM(body.pose_needed)) turnBody(plan, k, in, scratch);
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

/// What a body's wrench adds to its parent's, (3.8).
template <bool kPlain, typename T, typename R>
VWD_INLINE PlainWrench<T> handedOn(const Body<R>& body, const KernelInputs<R>& in,
                                   const JointMotion<T>& joint, const PlainWrench<T>& wrench) {
  PlainWrench<T> result;
  forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
    result =
        aboutParent<kPlain>(body, joint, inParentAxes<kPlain, axis.value>(body, in, joint, wrench));
  });
  return result;
}

/// Reports a plain body's wrench, which is in its parent's axes, in root axes; what it hands on.
template <typename T, typename R>
VWD_INLINE PlainWrench<T> reportTurned(const Body<R>& body, const KernelOutputs<R>& out,
                                       const Scratch<T, R>& scratch, const JointMotion<T>& joint,
                                       const PlainWrench<T>& turned) {
  if (out.root_axes) storeByParent(body, out, scratch, turned);
  return aboutParent<true>(body, joint, turned);
}

/// Reports the wrench of a plain body, where kReport says so, and hands it on.
/// Of one sample that is done where the axis is known, of packs, which spill registers there,
/// behind it.
template <PlainReport kReport, typename T, typename R>
VWD_INLINE PlainWrench<T> handPlain(const PlanView<R>& plan, const Body<R>& body,
                                    const KernelInputs<R>& in, const KernelOutputs<R>& out,
                                    const Scratch<T, R>& scratch, const PlainWrench<T>& wrench) {
  if (out.effort) {
    // (3.7), u3^T M
    store(out.effort + static_cast<std::size_t>(body.coordinate) * out.stride, wrench.torque.z);
  }
  if (kReport != PlainReport::kNone && body.child_axes >= 0 && out.child_axes) {
    storeChildAxes<true>(plan, body, in, out, scratch, wrench);
  }
  const JointMotion<T> joint = jointMotion<true, true>(body, in, scratch);
  if (kReport != PlainReport::kRootAxes) return handedOn<true>(body, in, joint, wrench);
  PlainWrench<T> turned, handed;
  constexpr bool kOneSample = sizeof(T) == sizeof(R);
  forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
    turned = inParentAxes<true, axis.value>(body, in, joint, wrench);
    if (kOneSample) handed = reportTurned(body, out, scratch, joint, turned);
  });
  return kOneSample ? handed : reportTurned(body, out, scratch, joint, turned);
}

/// Turns the wrench of any other body into its parent's axes, reports it in root axes, and hands it
/// on, if it is handed on.
template <typename T, typename R>
VWD_INLINE void handByParent(const PlanView<R>& plan, const Body<R>& body,
                             const KernelInputs<R>& in, const KernelOutputs<R>& out,
                             const Scratch<T, R>& scratch, const PlainWrench<T>& wrench,
                             PlainWrench<T>& handed) {
  const JointMotion<T> joint = jointMotion<true, false>(body, in, scratch);
  PlainWrench<T> turned;
  forAxis(body.axis, [&](auto axis) VWD_LAMBDA {
    turned = inParentAxes<false, axis.value>(body, in, joint, wrench);
  });
  storeByParent(body, out, scratch, turned);
  if (!body.hands_on && !body.adds_to_parent) return;
  handed = aboutParent<false>(body, joint, turned);
  if (body.adds_to_parent) sumUp(plan, body, handed, scratch.wrenches);
}

/// Reports the wrench of any other body and hands it on, if it is handed on.
template <typename T, typename R>
VWD_INLINE void handAny(const PlanView<R>& plan, int k, const KernelInputs<R>& in,
                        const KernelOutputs<R>& out, const Scratch<T, R>& scratch,
                        const PlainWrench<T>& wrench, PlainWrench<T>& handed) {
  const Body<R>& body = plan.bodies[k];
  if (body.drives && out.effort) addEffort(body, wrench, out);
  if (body.reported) {
    if (body.child_axes >= 0 && out.child_axes) {
      storeChildAxes<false>(plan, body, in, out, scratch, wrench);
    }
    if (body.root_axes >= 0 && out.root_axes) {
      if (body.turned_by_parent) return handByParent(plan, body, in, out, scratch, wrench, handed);
      storeRootAxes(plan, k, in, out, scratch, wrench);
    }
  }
  if (!body.hands_on && !body.adds_to_parent) return;
  handed = handedOn<false>(body, in, jointMotion<true, false>(body, in, scratch), wrench);
  if (body.adds_to_parent) sumUp(plan, body, handed, scratch.wrenches);
}

/// Leaves to root: (3.8), and what is reported of it.
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
    if (body.plain_wrench == PlainReport::kNone) {
      handed = handPlain<PlainReport::kNone>(plan, body, in, out, scratch, wrench);
    } else if (body.plain_wrench == PlainReport::kRootAxes) {
      handed = handPlain<PlainReport::kRootAxes>(plan, body, in, out, scratch, wrench);
    } else if (body.plain_wrench == PlainReport::kChildAxes) {
      handed = handPlain<PlainReport::kChildAxes>(plan, body, in, out, scratch, wrench);
    } else {
      handAny(plan, k, in, out, scratch, wrench, handed);
    }
  }
}

/// Finds positions of the bodies that need a pose, and velocities where they are asked for.
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
      propagatePose<true>(body, joint, parent, pose);
    } else {
      propagatePose<false>(body, joint, parent, pose);
    }
  }
}

template <bool kStatic, typename T, typename R>
VWD_INLINE void sweepAll(const PlanView<R>& plan, const KernelInputs<R>& in,
                         const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  slidePositions(plan, in, scratch);
  sweepOut<kStatic>(plan, in, scratch);
  if (out.poses || out.twists) sweepPoses<kStatic>(plan, in, out, scratch);
  subtractApplied(plan, in, scratch);
  sweepIn(plan, in, out, scratch);
  storeKnownZeros<T>(plan, out);
  if (out.effort) addActuators<kStatic, T>(plan, in, out);
  if (out.poses || out.twists) storePoses(plan, out, scratch);
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
