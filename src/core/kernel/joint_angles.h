#pragma once

#include "core/kernel/sine_cosine.h"
#include "core/kernel/sweeps.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// Rz(q) Rz(phase).
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
  for (int i = 0; i < plan.angle_count; ++i) {
    sineCosine(positionOf<T>(plan.angles[i], in), scratch.sines[i], scratch.cosines[i], lanes);
  }
  const bool all = lanes.all();
  for (int i = 0; i < plan.angle_count; ++i) {
    const JointPosition<R>& joint = plan.angles[i];
    if (!all) sineCosineOutside(positionOf<T>(joint, in), scratch.sines[i], scratch.cosines[i]);
    if (joint.turned) {
      turnByPhase(joint.phase_cos, joint.phase_sin, scratch.cosines[i], scratch.sines[i]);
    }
  }
}

/// The same for one sample: the joints side by side in packs. The arrays of `scratch` are as long
/// as whole packs.
template <int kWidth, typename R>
VWD_INLINE void sampleAngles(const PlanView<R>& plan, const KernelInputs<R>& in,
                             const Scratch<R, R>& scratch) {
  using T = Pack<R, kWidth>;
  R* const angles = scratch.angles;
  for (int i = 0; i < plan.angle_count; ++i) angles[i] = positionOf<R>(plan.angles[i], in);
  Lanes<R, kWidth> lanes;
  for (int i = 0; i < plan.angle_count; i += kWidth) {
    T sine, cosine;
    sineCosine(load<T>(angles + i), sine, cosine, lanes);
    if (!lanes.all()) sineCosineOutside(load<T>(angles + i), sine, cosine);
    const T phase_cos = load<T>(scratch.phase_cos + i), phase_sin = load<T>(scratch.phase_sin + i);
    const T unturned_cosine = cosine, unturned_sine = sine;
    turnByPhase(phase_cos, phase_sin, cosine, sine);
    const auto turned =
        (phase_cos.v != R(1)) | (phase_sin.v != R(0));  // the others keep a zero's sign
    cosine = T(turned ? cosine.v : unturned_cosine.v);
    sine = T(turned ? sine.v : unturned_sine.v);
    store(scratch.cosines + i, cosine);
    store(scratch.sines + i, sine);
  }
}

/// The same for other number types, by functions of their own.
template <typename T, typename R, typename Function>
VWD_INLINE void plainAngles(const PlanView<R>& plan, const KernelInputs<R>& in,
                            const Scratch<T, R>& scratch, Function sine_of, Function cosine_of) {
  for (int i = 0; i < plan.angle_count; ++i) {
    const JointPosition<R>& joint = plan.angles[i];
    const T angle = positionOf<T>(joint, in);
    scratch.cosines[i] = cosine_of(angle);
    scratch.sines[i] = sine_of(angle);
    if (joint.turned) {
      turnByPhase(joint.phase_cos, joint.phase_sin, scratch.cosines[i], scratch.sines[i]);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
