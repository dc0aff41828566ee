#pragma once

#include "base/number_choices.h"
#include "loops/kernel/frames.h"

namespace virtual_work_dynamics {
namespace {  // see loop_kernel.h

// What touches a plane in a point; see TouchConditions.

/// A unit vector along v, and how it changes with v; zero where v is.
template <typename T>
struct Direction {
  Vec3<T> u, ud;
};
template <typename T>
VWD_INLINE Direction<T> directionOf(const Vec3<T>& v, const Vec3<T>& vd) {
  const T length = squareRoot(dot(v, v));
  const T share = wherePositive(length, T(1.0) / length, T(0.0));
  const Vec3<T> u = scaled(share, v);
  return {u, scaled(share, addScaled(vd, -dot(u, vd), u))};
}

/// The axes of a contact, its point from the child's origin, and how they change; the normal rests.
template <typename T>
struct Contact {
  Vec3<T> x, y, normal, lever, xd, yd, leverd;
};

// The lowest point of a torus: from its centre against m, the normal less its part along the axle,
// to the middle of the tube, and from there against the normal.
template <typename T>
VWD_INLINE void findLowest(const TouchShape& touch, const Vec3<T>& axle, const Vec3<T>& w,
                           Contact<T>& contact) {
  const Vec3<T>& normal = contact.normal;
  const Vec3<T> axled = cross(w, axle);
  const T lean = dot(normal, axle), leand = dot(normal, axled);
  const Direction<T> m =
      directionOf(addScaled(normal, -lean, axle), addScaled(scaled(-leand, axle), -lean, axled));
  contact.lever = addScaled(scaled(-touch.tube_radius, normal), -touch.radius, m.u);
  contact.leverd = scaled(-touch.radius, m.ud);
}

/// @param kMoves whether it is asked how the contact changes
/// @param P the plane's axes. @param w how C turns as P sees it
template <bool kMoves, typename T>
VWD_INLINE Contact<T> contactOf(const ClosureShape& shape, const T* links, const T* P,
                                const Vec3<T>& w) {
  const TouchShape& touch = *shape.touch;
  const Vec3<T> zero = zeroVector<T>();
  Contact<T> contact{vectorAt(P), vectorAt(P + 3), vectorAt(P + 6), zero, zero, zero, zero};
  const Vec3<T>& normal = contact.normal;
  if (touch.axes == TouchShape::Axes::kOfPlane) {
    contact.lever = scaled(-touch.tube_radius, normal);
    return contact;
  }
  Direction<T> x;
  if (touch.axes == TouchShape::Axes::kOfWheel) {
    const Vec3<T> axle = frameAxis(shape.child, links, 2);
    findLowest(touch, axle, w, contact);
    x = directionOf(cross(axle, normal), cross(cross(w, axle), normal));
  } else {
    const Vec3<T> blade = frameAxis(shape.child, links, 0), bladed = cross(w, blade);
    x = directionOf(addScaled(blade, -dot(normal, blade), normal),
                    addScaled(bladed, -dot(normal, bladed), normal));
  }
  contact.x = x.u;
  contact.y = cross(normal, x.u);
  if (!kMoves) return contact;
  contact.xd = x.ud;
  contact.yd = cross(normal, x.ud);
  return contact;
}

template <typename T>
VWD_INLINE void placeTouch(const ClosureShape& shape, const T* links, const ClosureNumbers& to) {
  T* const frames = reinterpret_cast<T*>(to.frames);
  T* const wrenches = reinterpret_cast<T*>(to.wrenches);
  T* const phi = reinterpret_cast<T*>(to.phi);
  placeFrame(shape.parent, links, frames + kFrameP, frames + kFramePo);
  const Contact<T> contact = contactOf<false>(shape, links, frames + kFrameP, zeroVector<T>());
  const Vec3<T> Co = frameOrigin(shape.child, links) + contact.lever;
  T* const R = frames + kFrameC;
  putVector(R, contact.x);
  putVector(R + 3, contact.y);
  putVector(R + 6, contact.normal);
  putVector(frames + kFrameCo, Co);
  const Vec3<T> r = Co - vectorAt(frames + kFramePo);
  for (int i = 0; i < shape.demand_count; ++i) {
    const Vec3<T> direction = turnedBy(R, shape.touch->directions[i]);
    putVector(wrenches + i * kWrenchNumbers, direction);
    phi[i] = shape.touch->has_position[i] ? dot(direction, r) : T(0.0);  // (3.3)
  }
  placeColumns(shape, links, frames, wrenches, reinterpret_cast<T*>(to.A), to.A_stride);  // (3.2)
}

// The derivative, as P sees it, of the velocity along each direction, for qdd = 0. The point of
// contact moves on the child.
template <typename T>
VWD_INLINE void moveTouch(const ClosureShape& shape, const T* links, const ClosureNumbers& to) {
  const T* const frames = reinterpret_cast<const T*>(to.frames);
  const T* const wrenches = reinterpret_cast<const T*>(to.wrenches);
  T* const turning = reinterpret_cast<T*>(to.turning);
  const PointMotion<T> seen =
      seenFromParent(shape, links, vectorAt(frames + kFramePo), frameOrigin(shape.child, links));
  const Contact<T> contact = contactOf<true>(shape, links, frames + kFrameP, seen.w);
  const Vec3<T> velocity = addCross(seen.v, seen.w, contact.lever);
  const Vec3<T> acceleration =
      addCross(addCross(seen.a, seen.alpha, contact.lever), seen.w, contact.leverd);
  for (int i = 0; i < shape.demand_count; ++i) {
    const double* const direction = shape.touch->directions[i];
    const Vec3<T> turned = addScaled(scaled(direction[0], contact.xd), direction[1], contact.yd);
    turning[i] = dot(vectorAt(wrenches + i * kWrenchNumbers), acceleration) + dot(turned, velocity);
  }
}

template <typename T>
void referToChild(const ClosureShape& shape, const double* link_numbers,
                  const double* frame_numbers, double* to) {
  const T* const links = reinterpret_cast<const T*>(link_numbers);
  const T* const frames = reinterpret_cast<const T*>(frame_numbers);
  T* const wrench = reinterpret_cast<T*>(to);
  const Vec3<T> lever = vectorAt(frames + kFrameCo) - frameOrigin(shape.child, links);
  putVector(wrench + 3, addCross(vectorAt(wrench + 3), lever, vectorAt(wrench)));
}

inline void findContact(const ClosureShape& shape, const double* links, const double* w,
                        double* to) {
  double P[9], origin[3];
  placeFrame(shape.parent, links, P, origin);
  const Contact<double> contact = contactOf<true>(shape, links, P, vectorAt(w));
  putVector(to + kContactR, contact.x);
  putVector(to + kContactR + 3, contact.y);
  putVector(to + kContactR + 6, contact.normal);
  putVector(to + kContactRd, contact.xd);
  putVector(to + kContactRd + 3, contact.yd);
  putVector(to + kContactRd + 6, zeroVector<double>());
  putVector(to + kContactLever, contact.lever);
  putVector(to + kContactLeverd, contact.leverd);
}

}  // namespace
}  // namespace virtual_work_dynamics
