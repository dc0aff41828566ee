#pragma once

#include "tree/kernel/sine_cosine.h"
#include "tree/kernel/sweeps.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// Returns the angle of a joint, and in `rest` what rounding took from multiplier * q + offset: at
/// a billion radians that is more than all errors of the recursion.
template <typename T, typename R>
VWD_INLINE T angleOf(const JointPosition<R>& joint, const KernelInputs<R>& in, T& rest) {
  const T q = load<T>(in.q + static_cast<std::size_t>(joint.coordinate) * in.stride);
  if (!joint.geared) {
    rest = T(R(0));
    return q;
  }
  const T offset = T(joint.offset), product = joint.multiplier * q, angle = product + offset;
  const T added = angle - product;
  rest =
      productRest(joint.multiplier, q, product) + ((product - (angle - added)) + (offset - added));
  return angle;
}

/// Turns a rotation further by the small angle `rest`.
template <typename R, typename T>
VWD_INLINE void turnByRest(const T& rest, T& cosine, T& sine) {
  const T c = cosine, s = sine, square = rest * rest;
  const T versine = square * mulAdd(R(-1) / 24, square, T(R(0.5)));
  const T small_sine = rest * mulAdd(R(-1) / 6, square, T(R(1)));
  cosine = c - mulAdd(small_sine, s, versine * c);
  sine = s + mulSub(small_sine, c, versine * s);
}

/// Returns Rz(q) Rz(phase).
template <typename S, typename T>
VWD_INLINE void turnByPhase(const S& phase_cos, const S& phase_sin, T& cosine, T& sine) {
  const T c = cosine, s = sine;
  cosine = subMul(phase_cos * c, phase_sin, s);
  sine = mulAdd(phase_sin, c, phase_cos * s);
}

/// Cosines and sines of all joints of a pack of samples.
template <typename R, int kWidth>
VWD_INLINE void packAngles(const PlanView<R>& plan, const KernelInputs<R>& in,
                           const Scratch<Pack<R, kWidth>, R>& scratch) {
  using T = Pack<R, kWidth>;
  Lanes<R, kWidth> lanes;
  T rest;
  for (int i = 0; i < plan.angle_count; ++i) {
    const T angle = angleOf(plan.angles[i], in, rest);
    sineCosine(angle, scratch.sines[i], scratch.cosines[i], lanes);
  }
  const bool all = lanes.all();
  for (int i = 0; i < plan.angle_count; ++i) {
    const JointPosition<R>& joint = plan.angles[i];
    T &sine = scratch.sines[i], &cosine = scratch.cosines[i];
    if (!all || joint.geared) {
      const T angle = angleOf(joint, in, rest);
      if (!all) sineCosineOutside(angle, rest, sine, cosine);
      if (joint.geared) turnByRest<R>(rest, cosine, sine);
    }
    if (joint.turned) turnByPhase(joint.phase_cos, joint.phase_sin, cosine, sine);
  }
}

/// Cosines and sines of one sample: the joints side by side in packs. The arrays of `scratch` are
/// as long as whole packs.
template <int kWidth, typename R>
VWD_INLINE void sampleAngles(const PlanView<R>& plan, const KernelInputs<R>& in,
                             const Scratch<R, R>& scratch) {
  using T = Pack<R, kWidth>;
  R* const angles = scratch.angles;
  R unused;
  for (int i = 0; i < plan.angle_count; ++i) {
    angles[i] = angleOf(plan.angles[i], in, plan.geared_angles ? scratch.rests[i] : unused);
  }
  Lanes<R, kWidth> lanes;
  for (int i = 0; i < plan.angle_count; i += kWidth) {
    T sine, cosine;
    const T angle = load<T>(angles + i);
    sineCosine(angle, sine, cosine, lanes);
    if (plan.geared_angles || !lanes.all()) {
      T rest = plan.geared_angles ? load<T>(scratch.rests + i) : T(R(0));
      if (!lanes.all()) sineCosineOutside(angle, rest, sine, cosine);
      const T straight_cosine = cosine, straight_sine = sine;
      turnByRest<R>(rest, cosine, sine);
      const auto straight = rest.v == T(R(0)).v;  // the others keep a zero's sign
      cosine = T(straight ? straight_cosine.v : cosine.v);
      sine = T(straight ? straight_sine.v : sine.v);
    }
    const T phase_cos = load<T>(scratch.phase_cos + i), phase_sin = load<T>(scratch.phase_sin + i);
    const T unturned_cosine = cosine, unturned_sine = sine;
    turnByPhase(phase_cos, phase_sin, cosine, sine);
    const auto turned = (phase_cos.v != R(1)) | (phase_sin.v != R(0));  // here, too
    cosine = T(turned ? cosine.v : unturned_cosine.v);
    sine = T(turned ? sine.v : unturned_sine.v);
    store(scratch.cosines + i, cosine);
    store(scratch.sines + i, sine);
  }
}

/// Cosines and sines of all joints for other number types, by functions of their own.
template <typename T, typename R, typename Function>
VWD_INLINE void plainAngles(const PlanView<R>& plan, const KernelInputs<R>& in,
                            const Scratch<T, R>& scratch, Function sine_of, Function cosine_of) {
  for (int i = 0; i < plan.angle_count; ++i) {
    const JointPosition<R>& joint = plan.angles[i];
    T rest;
    const T angle = angleOf(joint, in, rest);
    scratch.cosines[i] = cosine_of(angle);
    scratch.sines[i] = sine_of(angle);
    if (joint.geared) turnByRest<R>(rest, scratch.cosines[i], scratch.sines[i]);
    if (joint.turned) {
      turnByPhase(joint.phase_cos, joint.phase_sin, scratch.cosines[i], scratch.sines[i]);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
