#pragma once

#include "loops/kernel/links.h"

namespace virtual_work_dynamics {
namespace {  // see loop_kernel.h

// Frames of closures, how they move, and what moves the child's link.

using DemandKind = DemandShape::Kind;

template <typename T>
VWD_INLINE Vec3<T> frameOrigin(const FrameShape& frame, const T* links) {
  if (frame.link == 0) return constantVector<T>(frame.p_LoFo_L);
  const T* const link = links + frame.link * kLinkNumbers;
  return vectorAt(link + kLinkO) + turnedBy(link + kLinkR, frame.p_LoFo_L);
}

/// Axis i of a frame.
template <typename T>
VWD_INLINE Vec3<T> frameAxis(const FrameShape& frame, const T* links, int i) {
  if (frame.link == 0) return constantVector<T>(frame.R_LF + 3 * i);
  const T* const R = links + frame.link * kLinkNumbers + kLinkR;
  return frame.parallel ? vectorAt(R + 3 * i) : turnedBy(R, frame.R_LF + 3 * i);
}

template <typename T>
VWD_INLINE void placeFrame(const FrameShape& frame, const T* links, T* R, T* o) {
  if (frame.link == 0) {
    for (int i = 0; i < 9; i += 3) putVector(R + i, constantVector<T>(frame.R_LF + i));
    putVector(o, constantVector<T>(frame.p_LoFo_L));
    return;
  }
  const T* const link = links + frame.link * kLinkNumbers;
  for (int i = 0; i < 9; i += 3) {
    putVector(R + i, frame.parallel ? vectorAt(link + kLinkR + i)
                                    : turnedBy(link + kLinkR, frame.R_LF + i));
  }
  putVector(o, vectorAt(link + kLinkO) + turnedBy(link + kLinkR, frame.p_LoFo_L));
}

/// A row of A is the generalized force of the wrench that a multiplier of one exerts: (3.3),
/// dPhi/dq.
template <typename T>
VWD_INLINE void placeColumns(const ClosureShape& shape, const T* links, const T* frames,
                             const T* wrenches, T* A, std::size_t A_stride) {
  const Vec3<T> Co = vectorAt(frames + kFrameCo);
  for (int k = 0; k < shape.step_count; ++k) {
    const StepShape& step = shape.steps[k];
    const T* const link = links + step.link * kLinkNumbers;
    const Vec3<T> along = scaled(step.factor, vectorAt(link + kLinkZ));
    const Vec3<T> moved = step.slides ? along : cross(along, Co - vectorAt(link + kLinkO));
    T* const column = A + static_cast<std::size_t>(step.coordinate) * A_stride;
    for (int i = 0; i < shape.demand_count; ++i) {
      const T* const wrench = wrenches + i * kWrenchNumbers;
      T entry;
      if (shape.demands[i].kind != DemandKind::kNormal) {
        entry = dot(vectorAt(wrench), moved);
      } else {
        entry = step.slides ? T(0.0) : dot(vectorAt(wrench + 3), along);
      }
      column[i] = step.starts ? entry : column[i] + entry;
    }
  }
}

/// How a point of a link moves.
template <typename T>
struct PointMotion {
  Vec3<T> v, w, a, alpha;
};

template <typename T>
VWD_INLINE PointMotion<T> motionAt(const T* link, const Vec3<T>& point) {
  PointMotion<T> at;
  at.w = vectorAt(link + kLinkW);
  at.alpha = vectorAt(link + kLinkAlpha);
  const Vec3<T> r = point - vectorAt(link + kLinkO), turned = cross(at.w, r);
  at.v = vectorAt(link + kLinkV) + turned;
  at.a = addCross(addCross(vectorAt(link + kLinkA), at.alpha, r), at.w, turned);
  return at;
}

/// The motion of a point C of the child that an observer on P sees, who moves with the parent's
/// link; w and alpha are in axes at rest.
template <typename T>
VWD_INLINE PointMotion<T> seenFromParent(const ClosureShape& shape, const T* links,
                                         const Vec3<T>& Po, const Vec3<T>& Co) {
  PointMotion<T> C{zeroVector<T>(), zeroVector<T>(), zeroVector<T>(), zeroVector<T>()};
  if (shape.child.link > 0) C = motionAt(links + shape.child.link * kLinkNumbers, Co);
  if (shape.parent.link == 0) return C;
  const PointMotion<T> P = motionAt(links + shape.parent.link * kLinkNumbers, Po);
  const Vec3<T> r = Co - Po, carried = cross(P.w, r);
  PointMotion<T> seen;
  seen.v = C.v - P.v - carried;
  seen.a = C.a - P.a - cross(P.alpha, r) - cross(P.w, addScaled(carried, T(2.0), seen.v));
  seen.w = C.w - P.w;
  seen.alpha = C.alpha - P.alpha - cross(P.w, C.w);
  return seen;
}

}  // namespace
}  // namespace virtual_work_dynamics
