#pragma once

#include "tree/kernel/joint_motion.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// The vector from O_k of a reaction's body to the point of its moment, in Z axes. Leads from body
/// to body, so that it loses no digits where both are far from the root.
template <typename T, typename R>
VWD_INLINE Vec3<T> pointOf(const PlanView<R>& plan, const MovedMoment<R>& moved,
                           const KernelInputs<R>& in, const Scratch<T, R>& scratch) {
  Vec3<T> p = {T(moved.p_ZoPo_Z.x), T(moved.p_ZoPo_Z.y), T(moved.p_ZoPo_Z.z)};
  for (int i = moved.steps_begin; i < moved.steps_end; ++i) {
    const PointStep& step = plan.point_steps[i];
    const Body<R>& body = plan.bodies[step.body];
    const JointMotion<T> joint = jointMotion<true, false>(body, in, scratch);
    const bool turns = body.mobility == Mobility::kRevolute;
    const Vec3<T> origin =
        body.mobility == Mobility::kPrismatic
            ? originInParent(body, joint.slide)
            : Vec3<T>{T(body.p_PoZo_P.x), T(body.p_PoZo_P.y), T(body.p_PoZo_P.z)};
    if (step.down) {
      p = p - origin;
      forAxis(body.axis, [&](auto axis) VWD_LAMBDA { p = toChild<axis.value>(body.R_PZ, p); });
      if (turns) p = transposeTimes(joint.Rz, p);
      if (VWD_SELDOM(body.mobility == Mobility::kOriented))
        p = transposeTimes(orientationOf<T>(body, in), p);
    } else {
      if (turns) p = times(joint.Rz, p);
      if (VWD_SELDOM(body.mobility == Mobility::kOriented))
        p = times(orientationOf<T>(body, in), p);
      forAxis(body.axis, [&](auto axis) VWD_LAMBDA { p = toParent<axis.value>(body.R_PZ, p); });
      p = origin + p;
    }
  }
  return p;
}

/// Moves reported moments, with poses and twists, to the points that they are wanted about.
template <typename T, typename R>
VWD_INLINE void moveMoments(const PlanView<R>& plan, const KernelInputs<R>& in,
                            const KernelOutputs<R>& out, const Scratch<T, R>& scratch) {
  for (int i = 0; i < plan.moved_count; ++i) {
    const MovedMoment<R>& moved = plan.moved[i];
    const std::size_t index = static_cast<std::size_t>(moved.output);
    const ReactionOutput<R>& output =
        moved.in_root_axes ? plan.root_axes[moved.output] : plan.child_axes[moved.output];
    const Vec3<T> r_Z = pointOf(plan, moved, in, scratch);
    const Vec3<T> r =
        moved.in_root_axes ? times(scratch.poses[output.body].R_0Z, r_Z) : times(output.R_KZ, r_Z);
    if (R* const wrench = moved.in_root_axes ? out.root_axes : out.child_axes) {
      R* const torque = wrench + (6 * index + 3) * out.stride;
      const Vec3<T> force = loadVector<T>(wrench + 6 * index * out.stride, out.stride);
      storeVector(addCross(loadVector<T>(torque, out.stride), force, r), torque, out.stride);
    }
    if (moved.in_root_axes && out.poses) {
      R* const position = out.poses + 12 * index * out.stride;
      storeVector(loadVector<T>(position, out.stride) + r, position, out.stride);
    }
    if (moved.in_root_axes && out.twists) {
      R* const v = out.twists + 6 * index * out.stride;
      const Vec3<T> w = loadVector<T>(v + 3 * out.stride, out.stride);
      storeVector(addCross(loadVector<T>(v, out.stride), w, r), v, out.stride);  // (2.6)
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
