#pragma once

#include <cmath>
#include <vector>

#include "core/plan.h"

namespace virtual_work_dynamics {

// The recursive virtual-work model of Stroe & Staicu (2010), templated on the number type. Symbols
// are those of notation.h; every quantity of a body is in its own frame Z, z along the joint axis
// u3. Gravity is carried as gamma_root = -g, so that (3.6) needs no term of its own.

/// Motion and wrench of one body at one instant.
template <typename T>
struct BodyState {
  RotationZ<T> Rz{};   ///< rotation by the joint angle
  Vec3<T> p_PoZo_P{};  ///< r_{k,k-1}: contains the slide of a prismatic joint
  Vec3<T> w{};         ///< omega_{k0}
  Vec3<T> alpha{};     ///< epsilon_{k0}
  Vec3<T> gamma{};     ///< gamma_{k0} - g
  Mat3<T> U{};         ///< w~ w~ + alpha~
  Vec3<T> F{};         ///< F_k of (3.8)
  Vec3<T> M{};         ///< M_k of (3.8), about O_k
  Vec3<T> v{};         ///< v_{k0}; only for requested twists
  Mat3<T> R_0Z{};      ///< a_{k0}^T; only where needed
  Vec3<T> p_0{};       ///< O_k in the root link; only where needed
};

/// Force and moment in whatever axes the holder says.
template <typename T>
struct PlainWrench {
  Vec3<T> force{};
  Vec3<T> torque{};
};

/// U = w~ w~ + alpha~: the acceleration of the point r of a body is gamma + U r.
template <typename T>
inline Mat3<T> accelerationGradient(const Vec3<T>& w, const Vec3<T>& alpha) {
  const T xx = w.x * w.x, yy = w.y * w.y, zz = w.z * w.z;
  const T xy = w.x * w.y, xz = w.x * w.z, yz = w.y * w.z;
  return {-(yy + zz),   xy - alpha.z, xz + alpha.y,  //
          xy + alpha.z, -(xx + zz),   yz - alpha.x,  //
          xz - alpha.y, yz + alpha.x, -(xx + yy)};
}

/// Integral of r x (U r) dm over a body: J alpha + w x (J w), from the second moment of mass G.
template <typename T>
inline Vec3<T> momentOfInertiaForces(const Mat3<T>& U, const Sym3<T>& G) {
  return {(U.zx * G.xy + U.zy * G.yy + U.zz * G.yz) - (U.yx * G.xz + U.yy * G.yz + U.yz * G.zz),
          (U.xx * G.xz + U.xy * G.yz + U.xz * G.zz) - (U.zx * G.xx + U.zy * G.xy + U.zz * G.xz),
          (U.yx * G.xx + U.yy * G.xy + U.yz * G.xz) - (U.xx * G.xy + U.xy * G.yy + U.xz * G.yz)};
}

/// Motion of a body from its parent's: (2.5), (2.7) with b = gamma_p + U_p r.
template <typename T>
inline void propagateMotion(const Body<T>& body, const BodyState<T>& parent, T q, T qd, T qdd,
                            BodyState<T>& state) {
  using std::cos;
  using std::sin;
  state.p_PoZo_P = body.p_PoZo_P;
  if (body.mobility == Mobility::kPrismatic) {
    state.p_PoZo_P = state.p_PoZo_P + q * columnZ(body.R_PZ);
  }
  const Vec3<T> b = parent.gamma + parent.U * state.p_PoZo_P;
  state.w = transposeTimes(body.R_PZ, parent.w);
  state.alpha = transposeTimes(body.R_PZ, parent.alpha);
  state.gamma = transposeTimes(body.R_PZ, b);
  if (body.mobility == Mobility::kRevolute) {
    state.Rz = {cos(q), sin(q)};
    state.w = state.Rz.transposeTimes(state.w);
    state.alpha = state.Rz.transposeTimes(state.alpha);
    state.gamma = state.Rz.transposeTimes(state.gamma);
    state.w.z = state.w.z + qd;                      // (2.5)
    state.alpha.x = state.alpha.x + qd * state.w.y;  // (2.7), w x u3 = (w_y, -w_x, 0)
    state.alpha.y = state.alpha.y - qd * state.w.x;
    state.alpha.z = state.alpha.z + qdd;
  } else if (body.mobility == Mobility::kPrismatic) {
    const T qd2 = qd + qd;
    state.gamma.x = state.gamma.x + qd2 * state.w.y;  // (2.7), 2 v w x u3
    state.gamma.y = state.gamma.y - qd2 * state.w.x;
    state.gamma.z = state.gamma.z + qdd;
  }
  state.U = accelerationGradient(state.w, state.alpha);
}

/// (3.5) less the weight, which gamma carries: F_k0 and M_k0.
template <typename T>
inline void inertiaWrench(const Body<T>& body, BodyState<T>& state) {
  state.F = body.mass * state.gamma + state.U * body.h;
  state.M = cross(body.h, state.gamma) + momentOfInertiaForces(state.U, body.G);
}

/// A vector in the body's Z frame -> the parent's.
template <typename T>
inline Vec3<T> toParent(const Body<T>& body, const BodyState<T>& state, const Vec3<T>& v) {
  return body.R_PZ * (body.mobility == Mobility::kRevolute ? state.Rz * v : v);
}

/// (3.8): adds a body's wrench to its parent's.
template <typename T>
inline void addToParent(const Body<T>& body, const BodyState<T>& state, BodyState<T>& parent) {
  const Vec3<T> F_P = toParent(body, state, state.F);
  const Vec3<T> M_P = toParent(body, state, state.M);
  parent.F = parent.F + F_P;
  parent.M = parent.M + M_P + cross(state.p_PoZo_P, F_P);
}

/// Pose in the root link: a_{k0}^T by composition.
template <typename T>
inline void propagatePose(const Body<T>& body, const BodyState<T>& parent, BodyState<T>& state) {
  state.p_0 = parent.p_0 + parent.R_0Z * state.p_PoZo_P;
  state.R_0Z = parent.R_0Z * body.R_PZ;
  if (body.mobility == Mobility::kRevolute) state.R_0Z = state.R_0Z * state.Rz;
}

/// (2.6).
template <typename T>
inline void propagateVelocity(const Body<T>& body, const BodyState<T>& parent, T qd,
                              BodyState<T>& state) {
  state.v = transposeTimes(body.R_PZ, parent.v + cross(parent.w, state.p_PoZo_P));
  if (body.mobility == Mobility::kRevolute) state.v = state.Rz.transposeTimes(state.v);
  if (body.mobility == Mobility::kPrismatic) state.v.z = state.v.z + qd;
}

/// -f*, -m* of (3.8) for the applied wrenches: `values` are in Z axes and about O_k for those given
/// in link axes, as given for those in root axes.
template <typename T>
inline void subtractApplied(const Plan<T>& plan, const std::vector<PlainWrench<T>>& values,
                            std::vector<BodyState<T>>& states) {
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    const AppliedOutside<T>& where = plan.applied[i];
    if (where.body < 0) continue;
    BodyState<T>& state = states[where.body];
    Vec3<T> force = values[i].force;
    Vec3<T> moment = values[i].torque;
    if (where.in_root_axes) {
      force = transposeTimes(state.R_0Z, force);
      moment = transposeTimes(state.R_0Z, moment) + cross(where.p_ZoA_Z, force);
    }
    state.F = state.F - force;
    state.M = state.M - moment;
  }
}

/// Root to leaves: motions (2.5)-(2.7) and the wrenches (3.5) of the single bodies.
template <typename T>
void sweepOut(const Plan<T>& plan, const T* q, const T* qd, const T* qdd,
              std::vector<BodyState<T>>& states) {
  states[0].gamma = plan.gamma_root;
  if (plan.bodies[0].wrench_needed) inertiaWrench(plan.bodies[0], states[0]);
  for (std::size_t k = 1; k < plan.bodies.size(); ++k) {
    const Body<T>& body = plan.bodies[k];
    BodyState<T>& state = states[k];
    const BodyState<T>& parent = states[body.parent];
    T position = T(0), velocity = T(0), acceleration = T(0);
    if (body.coordinate >= 0) {
      position = body.multiplier * q[body.coordinate] + body.offset;
      if (!plan.static_motion) {
        velocity = body.multiplier * qd[body.coordinate];
        acceleration = body.multiplier * qdd[body.coordinate];
      }
    }
    propagateMotion(body, parent, position, velocity, acceleration, state);
    if (body.pose_needed) propagatePose(body, parent, state);
    if (plan.twists) propagateVelocity(body, parent, velocity, state);
    if (body.wrench_needed) inertiaWrench(body, state);
  }
}

/// Leaves to root: (3.8), and the active efforts (3.7) where `effort` is not null.
template <typename T>
void sweepIn(const Plan<T>& plan, std::vector<BodyState<T>>& states, T* effort) {
  if (effort) {
    for (int i = 0; i < plan.coordinates; ++i) effort[i] = T(0);
  }
  for (std::size_t k = plan.bodies.size(); k-- > 1;) {
    const Body<T>& body = plan.bodies[k];
    if (!body.wrench_needed) continue;
    const BodyState<T>& state = states[k];
    if (effort && body.coordinate >= 0) {
      const T along_axis = body.mobility == Mobility::kPrismatic ? state.F.z : state.M.z;
      effort[body.coordinate] = effort[body.coordinate] + body.multiplier * along_axis;
    }
    if (plan.bodies[body.parent].wrench_needed) addToParent(body, state, states[body.parent]);
  }
}

/// The wrench to report, in Z axes: all of it, or without the component along the joint axis.
template <typename T>
inline PlainWrench<T> reported(const Plan<T>& plan, const ReactionOutput<T>& output,
                               const BodyState<T>& state) {
  PlainWrench<T> wrench{state.F, state.M};
  if (output.drop_active) {
    const Mobility mobility = plan.bodies[output.body].mobility;
    if (mobility == Mobility::kRevolute) wrench.torque.z = T(0);
    if (mobility == Mobility::kPrismatic) wrench.force.z = T(0);
  }
  return wrench;
}

template <typename T>
inline PlainWrench<T> rotated(const Mat3<T>& R, const PlainWrench<T>& wrench) {
  return {R * wrench.force, R * wrench.torque};
}

}  // namespace virtual_work_dynamics
