#pragma once

#include "tree/kernel/axis_rotation.h"
#include "tree/kernel/kernel.h"
#include "tree/kernel/vec3_operations.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

// The recursive virtual-work model of Stroe & Staicu (2010), templated on the number type T of the
// samples and R of the constants. Symbols are those of notation.h, doc/theory.md derives each line;
// every quantity of a body is in its own frame Z, z along the joint axis u3.
//
// Departs from (3.6): gravity is a vector, carried as gamma_root = -g instead of weights.

/// Motion of a body, in its Z axes.
template <typename T>
struct BodyMotion {
  Vec3<T> w;      ///< omega_{k0}
  Vec3<T> alpha;  ///< epsilon_{k0}
  Vec3<T> gamma;  ///< gamma_{k0} - g
  Mat3<T> U;      ///< w~ w~ + alpha~: the acceleration of the point r is gamma + U r
};

/// Position, velocity and acceleration of a joint.
template <typename T>
struct JointMotion {
  RotationZ<T> Rz;  ///< rotation of a joint that turns
  T slide;          ///< position of a joint that slides
  T qd;
  T qdd;
};

/// The rotation of an oriented body, child axes -> those in which it is not turned.
template <typename T, typename R>
VWD_INLINE Mat3<T> orientationOf(const Body<R>& body, const KernelInputs<R>& in) {
  const std::size_t stride = in.orientation_stride;
  const R* const from = in.orientations + 4 * static_cast<std::size_t>(body.orientation) * stride;
  const T x = load<T>(from), y = load<T>(from + stride), z = load<T>(from + 2 * stride),
          w = load<T>(from + 3 * stride);
  const T one = T(R(1)), x2 = x + x, y2 = y + y, z2 = z + z;
  return {one - mulAdd(y, y2, z * z2), subMul(x * y2, w, z2),       mulAdd(w, y2, x * z2),
          mulAdd(w, z2, x * y2),       one - mulAdd(x, x2, z * z2), subMul(y * z2, w, x2),
          subMul(x * z2, w, y2),       mulAdd(w, x2, y * z2),       one - mulAdd(x, x2, y * y2)};
}

/// U = w~ w~ + alpha~, the bracket of (2.7) and (3.5).
template <typename T>
VWD_INLINE Mat3<T> accelerationGradient(const Vec3<T>& w, const Vec3<T>& alpha) {
  const T yy = w.y * w.y, zz = w.z * w.z;
  return {minusMulSub(w.y, w.y, zz), mulSub(w.x, w.y, alpha.z), mulAdd(w.x, w.z, alpha.y),
          mulAdd(w.x, w.y, alpha.z), minusMulSub(w.x, w.x, zz), mulSub(w.y, w.z, alpha.x),
          mulSub(w.x, w.z, alpha.y), mulAdd(w.y, w.z, alpha.x), minusMulSub(w.x, w.x, yy)};
}

/// r_{k,k-1}: contains the slide of a prismatic joint.
template <typename T, typename R>
VWD_INLINE Vec3<T> originInParent(const Body<R>& body, const T& slide) {
  return {mulAdd(body.R_PZ.xz, slide, T(body.p_PoZo_P.x)),
          mulAdd(body.R_PZ.yz, slide, T(body.p_PoZo_P.y)),
          mulAdd(body.R_PZ.zz, slide, T(body.p_PoZo_P.z))};
}

/// Returns sum + U r.
template <typename S, typename T>
VWD_INLINE Vec3<T> addProduct(const Vec3<T>& sum, const Mat3<T>& U, const Vec3<S>& r) {
  return {addDot(sum.x, r.x, r.y, r.z, Vec3<T>{U.xx, U.xy, U.xz}),
          addDot(sum.y, r.x, r.y, r.z, Vec3<T>{U.yx, U.yy, U.yz}),
          addDot(sum.z, r.x, r.y, r.z, Vec3<T>{U.zx, U.zy, U.zz})};
}

// Departs from (2.7): the print has a second a_{k,k-1} before this U r. It is spurious: r and U are
// in the parent's axes already, and (5.2) has the bracket without it.

/// Returns gamma + U r, the bracket of (2.7), for the origin r of a body in its parent; components
/// of r that are zero are left out.
template <typename S, typename T, typename R>
VWD_INLINE Vec3<T> accelerationOf(const Body<R>& body, const BodyMotion<T>& motion,
                                  const Vec3<S>& r) {
  const Mat3<T>& U = motion.U;
  Vec3<T> b = motion.gamma;
  if (body.offset_z) b = {mulAdd(r.z, U.xz, b.x), mulAdd(r.z, U.yz, b.y), mulAdd(r.z, U.zz, b.z)};
  if (body.offset_y) b = {mulAdd(r.y, U.xy, b.x), mulAdd(r.y, U.yy, b.y), mulAdd(r.y, U.zy, b.z)};
  if (body.offset_x) b = {mulAdd(r.x, U.xx, b.x), mulAdd(r.x, U.yx, b.y), mulAdd(r.x, U.zx, b.z)};
  return b;
}

/// Returns moment + r x force for the origin r of a body in its parent; components of r that are
/// zero are left out.
template <typename S, typename T, typename R>
VWD_INLINE Vec3<T> momentAt(const Body<R>& body, const Vec3<T>& moment, const Vec3<S>& r,
                            const Vec3<T>& force) {
  Vec3<T> sum = moment;
  if (body.offset_z) {
    sum.x = subMul(sum.x, r.z, force.y);
    sum.y = mulAdd(r.z, force.x, sum.y);
  }
  if (body.offset_y) {
    sum.x = mulAdd(r.y, force.z, sum.x);
    sum.z = subMul(sum.z, r.y, force.x);
  }
  if (body.offset_x) {
    sum.y = subMul(sum.y, r.x, force.z);
    sum.z = mulAdd(r.x, force.y, sum.z);
  }
  return sum;
}

/// What arrives at a body from its parent, in the parent's axes: omega, epsilon and, for the body's
/// own origin r, b = gamma_p + U_p r.
template <typename T>
struct Arrival {
  Vec3<T> w;
  Vec3<T> alpha;
  Vec3<T> b;
};

template <bool kStatic, typename T, typename R>
VWD_INLINE void arriveAt(const Body<R>& body, const T* slides, const BodyMotion<T>& parent,
                         Arrival<T>& arrival) {
  arrival.b = parent.gamma;
  if (kStatic) return;
  arrival.w = parent.w;
  arrival.alpha = parent.alpha;
  if (body.mobility == Mobility::kPrismatic) {
    arrival.b = accelerationOf(body, parent, originInParent(body, slides[body.slide]));
  } else {
    arrival.b = accelerationOf(body, parent, body.p_PoZo_P);
  }
}

/// Motion of a body from its parent's, (2.5) and (2.7). kPlain: see BodyUse::plain_motion.
template <bool kStatic, bool kPlain, AxisDirection kAxis, typename T, typename R>
VWD_INLINE void propagateMotion(const Body<R>& body, const KernelInputs<R>& in,
                                const JointMotion<T>& joint, const Arrival<T>& arrival,
                                BodyMotion<T>& motion) {
  const Mobility mobility = kPlain ? Mobility::kRevolute : body.mobility;
  if (!kStatic) {
    motion.w = toChild<kAxis>(body.R_PZ, arrival.w);          // (2.5), a w_p
    motion.alpha = toChild<kAxis>(body.R_PZ, arrival.alpha);  // (2.7), a eps_p
  }
  motion.gamma = toChild<kAxis>(body.R_PZ, arrival.b);  // (2.7), a (gamma_p + U_p r)
  if (mobility == Mobility::kRevolute) {
    motion.gamma = transposeTimes(joint.Rz, motion.gamma);
    if (kStatic) return;
    motion.w = transposeTimes(joint.Rz, motion.w);
    motion.alpha = transposeTimes(joint.Rz, motion.alpha);
    motion.w.z = motion.w.z + joint.qd;                             // (2.5), + qd u3
    motion.alpha.x = mulAdd(joint.qd, motion.w.y, motion.alpha.x);  // (2.7), + qd w x u3, where
    motion.alpha.y = subMul(motion.alpha.y, joint.qd, motion.w.x);  //   w x u3 = (w_y, -w_x, 0)
    motion.alpha.z = motion.alpha.z + joint.qdd;                    // (2.7), + qdd u3
  } else if (mobility == Mobility::kPrismatic && !kStatic) {
    const T qd2 = joint.qd + joint.qd;
    motion.gamma.x = mulAdd(qd2, motion.w.y, motion.gamma.x);  // (2.7), + 2 qd w x u3
    motion.gamma.y = subMul(motion.gamma.y, qd2, motion.w.x);
    motion.gamma.z = motion.gamma.z + joint.qdd;  // (2.7), + qdd u3
  } else if (VWD_SELDOM(mobility == Mobility::kOriented)) {
    const Mat3<T> turn = orientationOf<T>(body, in);
    motion.gamma = transposeTimes(turn, motion.gamma);
    if (!kStatic) {
      motion.w = transposeTimes(turn, motion.w);
      motion.alpha = transposeTimes(turn, motion.alpha);
    }
  }
  if (!kStatic) motion.U = accelerationGradient(motion.w, motion.alpha);
}

/// Motion of a body on a parent at rest, (2.5) and (2.7) with the parent's w and alpha zero.
template <bool kStatic, typename T, typename R>
VWD_INLINE void startMotion(const Body<R>& body, const KernelInputs<R>& in,
                            const JointMotion<T>& joint, BodyMotion<T>& motion) {
  const T zero = T(0);
  motion.gamma = {T(body.gamma_rest.x), T(body.gamma_rest.y), T(body.gamma_rest.z)};
  if (body.mobility == Mobility::kRevolute && !body.rest_along_z) {
    motion.gamma = transposeTimes(joint.Rz, body.gamma_rest);
  } else if (VWD_SELDOM(body.mobility == Mobility::kOriented)) {
    motion.gamma = transposeTimes(orientationOf<T>(body, in), motion.gamma);
  }
  if (kStatic) return;
  motion.w = motion.alpha = {zero, zero, zero};
  motion.U = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
  if (body.mobility == Mobility::kRevolute) {
    motion.w.z = joint.qd;       // (2.5)
    motion.alpha.z = joint.qdd;  // (2.7)
    motion.U.xx = motion.U.yy = -joint.qd * joint.qd;
    motion.U.xy = -joint.qdd;
    motion.U.yx = joint.qdd;
  } else if (body.mobility == Mobility::kPrismatic) {
    motion.gamma.z = motion.gamma.z + joint.qdd;
  }
}

// Departs from (3.5): J eps + w x (J w) is the integral of r x (U r) dm over the body, and comes
// from U and the second moment of mass G in 18 products.

/// Integral of r x (U r) dm over a body in two parts: the moment is `plus` - `minus`.
template <typename T, typename R>
VWD_INLINE void turningMoment(const Body<R>& body, const Mat3<T>& U, Vec3<T>& plus,
                              Vec3<T>& minus) {
  const Sym3<R>& G = body.G;
  plus = {G.yy * U.zy, G.zz * U.xz, G.xx * U.yx};
  minus = {G.zz * U.yz, G.xx * U.zx, G.yy * U.xy};
  if (body.diagonal) return;
  plus = {mulAdd(G.xy, U.zx, mulAdd(G.yz, U.zz, plus.x)),
          mulAdd(G.yz, U.xy, mulAdd(G.xz, U.xx, plus.y)),
          mulAdd(G.xz, U.yz, mulAdd(G.xy, U.yy, plus.z))};
  minus = {mulAdd(G.xz, U.yx, mulAdd(G.yz, U.yy, minus.x)),
           mulAdd(G.xy, U.zy, mulAdd(G.xz, U.zz, minus.y)),
           mulAdd(G.yz, U.xz, mulAdd(G.xy, U.xx, minus.z))};
}

/// The wrench (3.5) of a body with the opposite sign, less the weight (3.6), which gamma carries:
/// F_k0 = m gamma + U h and M_k0 = h x gamma + integral of r x (U r) dm.
template <bool kStatic, typename T, typename R>
VWD_INLINE PlainWrench<T> inertiaWrench(const Body<R>& body, const BodyMotion<T>& motion) {
  const Vec3<R>& h = body.h;
  const Vec3<T>& gamma = motion.gamma;
  Vec3<T> force = scaled(body.mass, gamma), plus, minus;  // (3.5), m gamma
  if (kStatic) {
    plus = minus = {T(0), T(0), T(0)};
  } else {
    turningMoment(body, motion.U, plus, minus);  // (3.5), J eps + w x (J w)
  }
  if (!body.centred) {
    if (!kStatic) force = addProduct(force, motion.U, h);                // (3.5), + U h
    plus = {mulAdd(h.y, gamma.z, plus.x), mulAdd(h.z, gamma.x, plus.y),  // (3.5), h x gamma
            mulAdd(h.x, gamma.y, plus.z)};
    minus = {mulAdd(h.z, gamma.y, minus.x), mulAdd(h.x, gamma.z, minus.y),
             mulAdd(h.y, gamma.x, minus.z)};
  }
  return {force, plus - minus};
}

/// The wrench (3.5) of a body on a parent at rest: U has the four entries of a turn about z.
template <bool kStatic, typename T, typename R>
VWD_INLINE PlainWrench<T> startWrench(const Body<R>& body, const BodyMotion<T>& motion) {
  const T zero = T(0);
  PlainWrench<T> wrench{{zero, zero, zero}, {zero, zero, zero}};
  if (!body.weightless) wrench = inertiaWrench<true>(body, motion);
  if (kStatic || body.mobility != Mobility::kRevolute) return wrench;
  const Mat3<T>& U = motion.U;
  const Vec3<R>& h = body.h;
  const Sym3<R>& G = body.G;
  wrench.force.x = mulAdd(h.x, U.xx, mulAdd(h.y, U.xy, wrench.force.x));
  wrench.force.y = mulAdd(h.x, U.yx, mulAdd(h.y, U.yy, wrench.force.y));
  wrench.torque.x = subMul(subMul(wrench.torque.x, G.xz, U.yx), G.yz, U.yy);
  wrench.torque.y = mulAdd(G.xz, U.xx, mulAdd(G.yz, U.xy, wrench.torque.y));
  wrench.torque.z = mulAdd(G.xx + G.yy, U.yx, wrench.torque.z);
  return wrench;
}

/// A body's wrench (3.8) in its parent's axes, still about O_k.
template <bool kPlain, AxisDirection kAxis, typename T, typename R>
VWD_INLINE PlainWrench<T> inParentAxes(const Body<R>& body, const KernelInputs<R>& in,
                                       const JointMotion<T>& joint, PlainWrench<T> wrench) {
  const Mobility mobility = kPlain ? Mobility::kRevolute : body.mobility;
  if (mobility == Mobility::kRevolute) {
    wrench = {times(joint.Rz, wrench.force), times(joint.Rz, wrench.torque)};
  } else if (VWD_SELDOM(mobility == Mobility::kOriented)) {
    const Mat3<T> turn = orientationOf<T>(body, in);
    wrench = {times(turn, wrench.force), times(turn, wrench.torque)};
  }
  return {toParent<kAxis>(body.R_PZ, wrench.force),    // (3.8), a^T F
          toParent<kAxis>(body.R_PZ, wrench.torque)};  // (3.8), a^T M
}

/// Moves it to the parent's origin: what the body adds to its parent's wrench, (3.8).
template <bool kPlain, typename T, typename R>
VWD_INLINE PlainWrench<T> aboutParent(const Body<R>& body, const JointMotion<T>& joint,
                                      const PlainWrench<T>& wrench) {
  if (!kPlain && body.mobility == Mobility::kPrismatic) {
    return {wrench.force,
            momentAt(body, wrench.torque, originInParent(body, joint.slide), wrench.force)};
  }
  return {wrench.force, momentAt(body, wrench.torque, body.p_PoZo_P, wrench.force)};  // r x F
}

}  // namespace
}  // namespace virtual_work_dynamics
