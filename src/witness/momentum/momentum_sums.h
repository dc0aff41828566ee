#pragma once

#include "witness/momentum/momentum.h"
#include "witness/momentum/root_vector.h"

namespace virtual_work_dynamics {
namespace {  // see momentum.h

/// A matrix by its columns.
struct Matrix {
  Vector x, y, z;
};

/// Sums of norms as ErrorBound makes them, and of velocity and distance from the root's origin:
/// with these two, what a wrench adds to efforts and to ground is known on the way out.
struct NormSums {
  double w, alpha, gamma, velocity, distance;

  double gradient() const { return w * w + alpha; }
};

/// Orientation and origin in root axes, and their first and second derivatives; gravity is in the
/// origin's.
struct BodyState {
  Matrix R, D, E;
  Vector p, v, a;
  NormSums norms;
};

inline Matrix matrixOf(const double* columns) {
  return {vectorOf(columns), vectorOf(columns + 3), vectorOf(columns + 6)};
}

inline Vector times(const Matrix& A, const double* v) {
  return A.x * v[0] + A.y * v[1] + A.z * v[2];
}

inline Matrix product(const Matrix& A, const double* columns) {
  return {times(A, columns), times(A, columns + 3), times(A, columns + 6)};
}

inline NormSums nextNorms(const MomentumBody& body, const MomentumJoint& joint,
                          const NormSums& parent) {
  const double distance = body.distance + joint.slide_norm;
  const double qd = __builtin_fabs(joint.rate), qdd = __builtin_fabs(joint.acceleration);
  NormSums sums = parent;
  sums.gamma += parent.gradient() * distance;
  sums.velocity += parent.w * distance;
  sums.distance += distance;
  if (body.slides) {
    sums.gamma += qdd + 2 * qd * parent.w;
    sums.velocity += qd;
  } else {
    sums.w += qd;
    sums.alpha += qdd + qd * parent.w;
  }
  return sums;
}

/// Composes R = R_P R_PZ and p = p_P + R_P r, differentiated twice.
inline void moveBody(const MomentumBody& body, const MomentumJoint& joint, const BodyState& parent,
                     BodyState& state) {
  const double qd = joint.rate, qdd = joint.acceleration;
  state.p = parent.p + times(parent.R, body.p_PoZo_P);
  state.v = parent.v + times(parent.D, body.p_PoZo_P);
  state.a = parent.a + times(parent.E, body.p_PoZo_P);
  const Matrix R = product(parent.R, joint.R_PZ);
  Matrix D = product(parent.D, joint.R_PZ);
  Matrix E = product(parent.E, joint.R_PZ);
  if (body.slides) {
    state.p += joint.slide * R.z;
    state.v += joint.slide * D.z + qd * R.z;
    state.a += joint.slide * E.z + 2 * qd * D.z + qdd * R.z;
  } else {
    // R_PZ' = qd (y, -x, 0), R_PZ'' = qdd (y, -x, 0) - qd^2 (x, y, 0)
    E.x += 2 * qd * D.y + qdd * R.y - qd * qd * R.x;
    E.y -= 2 * qd * D.x + qdd * R.x + qd * qd * R.y;
    D.x += qd * R.y;
    D.y -= qd * R.x;
  }
  state.R = R;
  state.D = D;
  state.E = E;
  state.norms = nextNorms(body, joint, parent.norms);
}

/// Sums over bodies and wrenches; the power's components are still to be added up.
struct RunningSums {
  Vector force, moment_zxy, power;
  double force_scale, moment_scale, power_scale;
};

inline void addScales(double force, double moment, const NormSums& at, RunningSums& sums) {
  sums.force_scale += force;
  sums.moment_scale += moment + at.distance * force;
  sums.power_scale += force * at.velocity + moment * at.w;
}

/// Rates of change of a body's momentum, angular momentum and kinetic energy. With the integrals
/// N = integral of r'' r^T dm of its points' accelerations, the last two are those of the columns
/// of R and N as of points of mass and the forces on them.
inline void addBody(const MomentumBody& body, const BodyState& state, RunningSums& sums) {
  const double *const G = body.G, *const h = body.h;
  const Matrix &R = state.R, &D = state.D, &E = state.E;
  const Vector& a = state.a;
  const Vector force = body.mass * a + times(E, h);
  const Matrix N = {E.x * G[0] + E.y * G[1] + E.z * G[2] + a * h[0],
                    E.x * G[1] + E.y * G[3] + E.z * G[4] + a * h[1],
                    E.x * G[2] + E.y * G[4] + E.z * G[5] + a * h[2]};
  sums.force += force;
  sums.moment_zxy +=
      crossZxy(state.p, force) + crossZxy(R.x, N.x) + crossZxy(R.y, N.y) + crossZxy(R.z, N.z);
  sums.power += state.v * force + D.x * N.x + D.y * N.y + D.z * N.z;

  const NormSums& norms = state.norms;
  const double gradient = norms.gradient();
  addScales(body.mass * norms.gamma + body.first * gradient,
            body.first * norms.gamma + body.second * gradient, norms, sums);
}

inline void addWrench(const MomentumWrench& wrench, const BodyState& state, RunningSums& sums) {
  const double *const f = wrench.force, *const t = wrench.torque;
  const Matrix &R = state.R, &D = state.D;
  const Vector force = wrench.in_root_axes ? vectorOf(f) : times(R, f);
  const Vector torque = wrench.in_root_axes ? vectorOf(t) : times(R, t);
  const Vector p = state.p + times(R, wrench.p_ZoA_Z), v = state.v + times(D, wrench.p_ZoA_Z);
  // Half the sum of r x r' over the axes r is the angular velocity.
  const Vector w_zxy = 0.5 * (crossZxy(R.x, D.x) + crossZxy(R.y, D.y) + crossZxy(R.z, D.z));
  sums.force -= force;
  sums.moment_zxy -= crossZxy(p, force) + yzx(yzx(torque));
  sums.power -= v * force + yzx(w_zxy) * torque;
  addScales(wrench.force_norm, wrench.moment_norm, state.norms, sums);
}

inline void sumMomentum(const MomentumInputs& in, void* memory, MomentumSums& result) {
  BodyState* const states = static_cast<BodyState*>(memory);
  const Vector zero = vectorOf(0, 0, 0);
  states[0].R = {vectorOf(1, 0, 0), vectorOf(0, 1, 0), vectorOf(0, 0, 1)};
  states[0].D = matrixOf(in.root_D);
  states[0].E = matrixOf(in.root_E);
  states[0].p = states[0].v = zero;
  states[0].a = vectorOf(in.gamma_root);
  states[0].norms = {in.w_norm, in.alpha_norm, in.gamma_norm, 0, 0};
  RunningSums sums = {zero, zero, zero, 0, 0, 0};
  for (std::size_t i = 0; i < in.body_count; ++i) {
    const MomentumBody& body = in.bodies[i];
    if (i > 0) moveBody(body, in.joints[i], states[body.parent], states[i]);
    if (!body.empty) addBody(body, states[i], sums);
  }
  for (std::size_t i = 0; i < in.wrench_count; ++i) {
    addWrench(in.wrenches[i], states[in.wrenches[i].body], sums);
  }
  double power[3];
  store(sums.power, power);
  store(sums.force, result.force);
  store(yzx(sums.moment_zxy), result.moment);
  result.power = power[0] + power[1] + power[2];
  result.force_scale = sums.force_scale;
  result.moment_scale = sums.moment_scale;
  result.power_scale = sums.power_scale;
}

const Momentum kMomentum = {sizeof(BodyState), sumMomentum};

}  // namespace
}  // namespace virtual_work_dynamics
