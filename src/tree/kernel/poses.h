#pragma once

#include "tree/kernel/recursion.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// Pose and velocity of a body, in root axes.
template <typename T>
struct BodyPose {
  Mat3<T> R_0Z;  ///< a_{k0}^T
  Vec3<T> p_0;   ///< O_k
  Vec3<T> v_0;   ///< v_{k0}
  Vec3<T> w_0;   ///< omega_{k0}
};

/// The rotation of a body from its parent's, at position 0 less the phase.
template <AxisDirection kAxis, typename T, typename R>
VWD_INLINE Mat3<T> unturnedRotation(const Body<R>& body, const Mat3<T>& R_0P) {
  const Vec3<T> x = toChild<kAxis>(body.R_PZ, Vec3<T>{R_0P.xx, R_0P.xy, R_0P.xz});
  const Vec3<T> y = toChild<kAxis>(body.R_PZ, Vec3<T>{R_0P.yx, R_0P.yy, R_0P.yz});
  const Vec3<T> z = toChild<kAxis>(body.R_PZ, Vec3<T>{R_0P.zx, R_0P.zy, R_0P.zz});
  return {x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z};
}

/// Returns A, turned as the body's joint turns.
template <typename T, typename R>
VWD_INLINE Mat3<T> turnedByJoint(const Body<R>& body, const KernelInputs<R>& in,
                                 const RotationZ<T>& Rz, const Mat3<T>& A) {
  if (body.mobility == Mobility::kRevolute) return times(A, Rz);
  if (VWD_SELDOM(body.mobility == Mobility::kOriented)) {
    const Mat3<T> turn = orientationOf<T>(body, in);
    const Vec3<T> a = transposeTimes(turn, Vec3<T>{A.xx, A.xy, A.xz});
    const Vec3<T> b = transposeTimes(turn, Vec3<T>{A.yx, A.yy, A.yz});
    const Vec3<T> c = transposeTimes(turn, Vec3<T>{A.zx, A.zy, A.zz});
    return {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
  }
  return A;
}

/// Position of a body from its parent's, and with kTwist its velocities (2.5) and (2.6) in root
/// axes; its rotation is there.
template <bool kTwist, typename T, typename R>
VWD_INLINE void propagatePose(const Body<R>& body, const JointMotion<T>& joint,
                              const BodyPose<T>& parent, BodyPose<T>& pose) {
  const Vec3<T> arm = body.mobility == Mobility::kPrismatic
                          ? times(parent.R_0Z, originInParent(body, joint.slide))
                          : columnTimes(parent.R_0Z, body.p_PoZo_P);
  pose.p_0 = parent.p_0 + arm;
  if (!kTwist) return;
  pose.w_0 = parent.w_0;
  pose.v_0 = addCross(parent.v_0, parent.w_0, arm);  // (2.6)
  const Vec3<T> u3{pose.R_0Z.xz, pose.R_0Z.yz, pose.R_0Z.zz};
  if (body.mobility == Mobility::kRevolute) pose.w_0 = pose.w_0 + scaled(joint.qd, u3);   // (2.5)
  if (body.mobility == Mobility::kPrismatic) pose.v_0 = pose.v_0 + scaled(joint.qd, u3);  // (2.6)
}

template <typename T, typename R>
VWD_INLINE void storeVector(const Vec3<T>& v, R* to, std::size_t stride) {
  store(to, v.x);
  store(to + stride, v.y);
  store(to + 2 * stride, v.z);
}

/// Writes the position of O_k, then R_0K = R_0Z R_KZ^T by rows.
template <typename T, typename R>
VWD_INLINE void storePose(const ReactionOutput<R>& output, const BodyPose<T>& pose, R* to,
                          std::size_t stride) {
  const Mat3<T>& A = pose.R_0Z;
  storeVector(pose.p_0, to, stride);
  storeVector(times(output.R_KZ, Vec3<T>{A.xx, A.xy, A.xz}), to + 3 * stride, stride);
  storeVector(times(output.R_KZ, Vec3<T>{A.yx, A.yy, A.yz}), to + 6 * stride, stride);
  storeVector(times(output.R_KZ, Vec3<T>{A.zx, A.zy, A.zz}), to + 9 * stride, stride);
}

}  // namespace
}  // namespace virtual_work_dynamics
