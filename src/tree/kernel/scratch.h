#pragma once

#include <cstdint>

#include "tree/kernel/sweeps.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// Deals out the arrays of a Scratch from one piece of memory; with a null pointer it only counts.
/// Addresses are integers until they are dealt, as nothing may be added to a null pointer.
class ScratchDealer {
 public:
  VWD_INLINE explicit ScratchDealer(void* memory)
      : memory_(reinterpret_cast<std::uintptr_t>(memory)) {}

  template <typename Item>
  VWD_INLINE Item* deal(std::size_t count) {
    const std::uintptr_t items = memory_ + used_;
    const std::size_t size = count * sizeof(Item);
    used_ += (size + kVectorAlignment - 1) / kVectorAlignment * kVectorAlignment;
    return reinterpret_cast<Item*>(items);
  }

  VWD_INLINE std::size_t used() const { return used_; }

 private:
  std::uintptr_t memory_;
  std::size_t used_ = 0;
};

/// `pad`: the arrays of angles are this many numbers longer.
template <typename T, typename R>
VWD_INLINE Scratch<T, R> dealScratch(const PlanView<R>& plan, std::size_t pad,
                                     ScratchDealer& dealer) {
  const std::size_t angles = static_cast<std::size_t>(plan.angle_count) + pad;
  const std::size_t bodies = static_cast<std::size_t>(plan.body_count);
  Scratch<T, R> scratch;
  scratch.cosines = dealer.deal<T>(angles);
  scratch.sines = dealer.deal<T>(angles);
  scratch.angles = dealer.deal<T>(pad ? angles : 0);
  scratch.rests = dealer.deal<T>(pad && plan.geared_angles ? angles : 0);
  scratch.phase_cos = dealer.deal<R>(pad ? angles : 0);
  scratch.phase_sin = dealer.deal<R>(pad ? angles : 0);
  scratch.slides = dealer.deal<T>(static_cast<std::size_t>(plan.slide_count));
  scratch.wrenches = dealer.deal<PlainWrench<T>>(static_cast<std::size_t>(plan.wrench_count));
  scratch.slots = dealer.deal<BodyMotion<T>>(static_cast<std::size_t>(plan.slots));
  scratch.poses = dealer.deal<BodyPose<T>>(plan.any_pose ? bodies : 0);
  return scratch;
}

/// Fills in what does not change from sample to sample.
template <typename T, typename R>
void prepareScratch(const PlanView<R>& plan, std::size_t pad, const Scratch<T, R>& scratch) {
  if (plan.any_pose) {
    const T zero = T(0), one = T(1);
    scratch.poses[0] = {{one, zero, zero, zero, one, zero, zero, zero, one},
                        {zero, zero, zero},
                        {zero, zero, zero},
                        {zero, zero, zero}};
  }
  for (std::size_t i = 0; pad && i < static_cast<std::size_t>(plan.angle_count) + pad; ++i) {
    const bool real = i < static_cast<std::size_t>(plan.angle_count);
    scratch.angles[i] = T(0);
    if (plan.geared_angles) scratch.rests[i] = T(0);
    scratch.phase_cos[i] = real ? plan.angles[i].phase_cos : R(1);
    scratch.phase_sin[i] = real ? plan.angles[i].phase_sin : R(0);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
