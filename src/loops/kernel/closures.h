#pragma once

#include "loops/kernel/conditions.h"
#include "loops/kernel/frames.h"
#include "loops/kernel/reactions.h"
#include "loops/kernel/teeth.h"
#include "loops/kernel/touches.h"

namespace virtual_work_dynamics {
namespace {  // see loop_kernel.h

template <typename T>
VWD_INLINE void placeAlong(const DemandShape& demand, const Vec3<T>& r, const T* frames, T& phi,
                           T* wrench) {
  const Vec3<T> axis = vectorAt(frames + kFrameP + 3 * demand.a);
  phi = dot(axis, r);  // (3.3)
  putVector(wrench, axis);
}
template <typename T>
VWD_INLINE void placeNormal(const DemandShape& demand, const T* frames, T& phi, T* wrench) {
  const Vec3<T> a = vectorAt(frames + kFrameP + 3 * demand.a);
  const Vec3<T> b = vectorAt(frames + kFrameC + 3 * demand.b);
  phi = dot(a, b);  // (3.3)
  putVector(wrench + 3, cross(b, a));
}

/// Conditions and the wrenches of unit multipliers.
template <typename T>
VWD_INLINE void placeConditions(const ClosureShape& shape, const T* frames, T* phi, T* wrenches) {
  const Vec3<T> r = vectorAt(frames + kFrameCo) - vectorAt(frames + kFramePo);  // (2.1)
  for (int i = 0; i < shape.demand_count; ++i) {
    const DemandShape& demand = shape.demands[i];
    T* const wrench = wrenches + i * kWrenchNumbers;
    if (demand.kind == DemandKind::kDistance) {
      const T distance = squareRoot(dot(r, r));
      const T share = wherePositive(distance, T(1.0) / distance, T(1.0));
      phi[i] = distance - T(shape.length);  // (3.3)
      putVector(wrench, scaled(share, r));
    } else if (demand.kind == DemandKind::kAlong) {
      placeAlong(demand, r, frames, phi[i], wrench);
    } else {
      placeNormal(demand, frames, phi[i], wrench);
    }
  }
}

/// The demands of the most usual closures: loops have constant lengths. What it computes agrees
/// with placeConditions() and placeColumns() bit for bit.
/// @param kAlong, kNormal how many of each kind, in this order
template <int kAlong, int kNormal>
struct UsualDemands {
  static constexpr int kCount = kAlong + kNormal;

  VWD_INLINE static bool are(const ClosureShape& shape) {
    return shape.along == kAlong && shape.demand_count == kCount;
  }

  template <typename T>
  VWD_INLINE static void placeConditions(const ClosureShape& shape, const T* frames, T* phi,
                                         T* wrenches) {
    const Vec3<T> r = vectorAt(frames + kFrameCo) - vectorAt(frames + kFramePo);  // (2.1)
    for (int i = 0; i < kAlong; ++i) {
      placeAlong(shape.demands[i], r, frames, phi[i], wrenches + i * kWrenchNumbers);
    }
    for (int i = kAlong; i < kCount; ++i) {
      placeNormal(shape.demands[i], frames, phi[i], wrenches + i * kWrenchNumbers);
    }
  }

  template <typename T>
  VWD_INLINE static void placeColumns(const ClosureShape& shape, const T* links, const T* frames,
                                      const T* wrenches, T* A, std::size_t A_stride) {
    const Vec3<T> Co = vectorAt(frames + kFrameCo);
    for (int k = 0; k < shape.step_count; ++k) {
      const StepShape& step = shape.steps[k];
      const T* const link = links + step.link * kLinkNumbers;
      const Vec3<T> along = scaled(step.factor, vectorAt(link + kLinkZ));
      const Vec3<T> moved = step.slides ? along : cross(along, Co - vectorAt(link + kLinkO));
      T entries[kCount];
      for (int i = 0; i < kAlong; ++i) {
        entries[i] = dot(vectorAt(wrenches + i * kWrenchNumbers), moved);
      }
      for (int i = kAlong; i < kCount; ++i) {
        const T entry = dot(vectorAt(wrenches + i * kWrenchNumbers + 3), along);
        entries[i] = step.slides ? T(0.0) : entry;
      }
      T* const column = A + static_cast<std::size_t>(step.coordinate) * A_stride;
      if (!step.starts) {
        for (int i = 0; i < kCount; ++i) entries[i] = column[i] + entries[i];
      }
      for (int i = 0; i < kCount; ++i) column[i] = entries[i];
    }
  }

  template <typename T>
  VWD_INLINE static void place(const ClosureShape& shape, const T* links, const T* frames,
                               const ClosureNumbers& to) {
    T* const wrenches = reinterpret_cast<T*>(to.wrenches);
    placeConditions(shape, frames, reinterpret_cast<T*>(to.phi), wrenches);
    placeColumns(shape, links, frames, wrenches, reinterpret_cast<T*>(to.A), to.A_stride);
  }
};

template <typename T>
void placeClosure(const ClosureShape& shape, const double* link_numbers, const ClosureNumbers& to) {
  const T* const links = reinterpret_cast<const T*>(link_numbers);
  T* const frames = reinterpret_cast<T*>(to.frames);
  T* const wrenches = reinterpret_cast<T*>(to.wrenches);
  if (shape.touch) return placeTouch(shape, links, to);
  if (shape.teeth) return placeTeeth(shape, links, to);
  placeFrame(shape.parent, links, frames + kFrameP, frames + kFramePo);
  placeFrame(shape.child, links, frames + kFrameC, frames + kFrameCo);
  using Pin = UsualDemands<3, 2>;
  using Ball = UsualDemands<3, 0>;
  if (Pin::are(shape)) return Pin::place(shape, links, frames, to);
  if (Ball::are(shape)) return Ball::place(shape, links, frames, to);
  placeConditions(shape, frames, reinterpret_cast<T*>(to.phi), wrenches);
  placeColumns(shape, links, frames, wrenches, reinterpret_cast<T*>(to.A), to.A_stride);
}

template <typename T>
void moveClosure(const ClosureShape& shape, const double* link_numbers, const ClosureNumbers& to) {
  const T* const links = reinterpret_cast<const T*>(link_numbers);
  const T* const frames = reinterpret_cast<const T*>(to.frames);
  const T* const wrenches = reinterpret_cast<const T*>(to.wrenches);
  T* const turning = reinterpret_cast<T*>(to.turning);
  if (shape.touch) return moveTouch(shape, links, to);
  if (shape.teeth) {
    turning[0] = T(0.0);  // its row is the same in every position
    return;
  }
  const PointMotion<T> seen =
      seenFromParent(shape, links, vectorAt(frames + kFramePo), vectorAt(frames + kFrameCo));
  for (int i = 0; i < shape.demand_count; ++i) {
    const DemandShape& demand = shape.demands[i];
    const Vec3<T> force = vectorAt(wrenches + i * kWrenchNumbers);
    if (demand.kind == DemandKind::kDistance) {
      const Vec3<T> r = vectorAt(frames + kFrameCo) - vectorAt(frames + kFramePo);
      const T distance = squareRoot(dot(r, r)), rate = dot(force, seen.v);
      const T across = subMul(dot(seen.v, seen.v), rate, rate);
      turning[i] = wherePositive(distance, across / distance + dot(force, seen.a), T(0.0));
    } else if (demand.kind == DemandKind::kAlong) {
      turning[i] = dot(force, seen.a);
    } else {
      const Vec3<T> normal = vectorAt(frames + kFrameP + 3 * demand.a);
      const Vec3<T> other = vectorAt(frames + kFrameC + 3 * demand.b);
      const Vec3<T> moment = vectorAt(wrenches + i * kWrenchNumbers + 3);
      turning[i] = subMul(mulAdd(dot(seen.w, normal), dot(seen.w, other), dot(moment, seen.alpha)),
                          dot(seen.w, seen.w), dot(normal, other));
    }
  }
}

template <int kWidth, typename T>
constexpr LoopFunctions loopFunctions() {
  return {placeLinks<kWidth, T>, moveLinks<T>,     placeClosure<T>, moveClosure<T>,
          sumTurns<T>,           addColumns<T>,    addMotion<T>,    scaleColumns<T>,
          findResiduals<T>,      sumWrenches<T>,   takeFlank<T>,    referToChild<T>,
          findClosureLoads<T>,   findReactions<T>, leaveOut,        reportWrench,
          findContact,           findMesh};
}

/// @param kWidth samples of a pack, and angles of one sample side by side
template <int kWidth>
const LoopKernel* loopKernel() {
  using Samples = Pack<double, kWidth>;
  static constexpr LoopKernel kKernel = {kWidth, loopFunctions<kWidth, double>(),
                                         loopFunctions<kWidth, Samples>()};
  return &kKernel;
}

}  // namespace
}  // namespace virtual_work_dynamics
