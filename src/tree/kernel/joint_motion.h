#pragma once

#include "tree/kernel/poses.h"
#include "tree/kernel/recursion.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// Memory of one evaluation; the arrays are as long as the plan's lists.
template <typename T, typename R>
struct Scratch {
  T* cosines;                ///< cosines of Plan::angles
  T* sines;                  ///< sines of Plan::angles
  T* slides;                 ///< positions of Plan::slides
  PlainWrench<T>* wrenches;  ///< the bodies', in Z axes and about O_k; partial sums behind them
  BodyMotion<T>* slots;      ///< motions that later children need
  BodyPose<T>* poses;        ///< poses of the bodies that need one; [0] is the root's
  T* angles;                 ///< see sampleAngles()
  T* rests;                  ///< see sampleAngles()
  R* phase_cos;              ///< see sampleAngles()
  R* phase_sin;              ///< see sampleAngles()
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

template <bool kStatic, bool kPlain, typename T, typename R>
VWD_INLINE JointMotion<T> jointMotion(const Body<R>& body, const KernelInputs<R>& in,
                                      const Scratch<T, R>& scratch) {
  JointMotion<T> joint;
  if (kPlain || body.angle >= 0) {
    joint.Rz = {scratch.cosines[body.angle], scratch.sines[body.angle]};
  }
  if (!kPlain && body.slide >= 0) joint.slide = scratch.slides[body.slide];
  if (!kStatic && (kPlain || body.coordinate >= 0)) {
    const bool geared = !kPlain && body.geared;
    joint.qd = coordinateOf<T>(in.qd, in.stride, body.coordinate, geared, body.multiplier);
    joint.qdd = coordinateOf<T>(in.qdd, in.stride, body.coordinate, geared, body.multiplier);
  }
  return joint;
}

}  // namespace
}  // namespace virtual_work_dynamics
