#pragma once

#include "witness/lagrange/lagrange_plan.h"
#include "witness/lagrange/variation_frames.h"

namespace virtual_work_dynamics {

// Lagrange's equations (4.1) of one link, one joint and one fictitious mobility (4.2). What is
// written down is kinetic energy E, force function U and virtual work; all derivatives are
// automatic.

/// Position, velocity and acceleration of one joint, which may depend on a direction: position and
/// velocity then have the derivative `multiplier` with respect to s and sd.
template <typename Real>
struct JointState {
  Real q = 0, qd = 0, qdd = 0;
  Real sine = 0, cosine = 1;

  template <std::size_t N>
  PositionNumber<Real, N> position(const std::array<Real, N>& multiplier) const {
    return {q, qd, multiplier};
  }
  template <std::size_t N>
  VelocityNumber<Real, N> velocity(const std::array<Real, N>& multiplier) const {
    return {qd, qdd, {}, multiplier, {}};
  }
};

/// Pose of the child link in its parent and its time derivative.
template <typename Real, std::size_t N>
struct RelativePose {
  Orientation<Real, N> orientation;
  Origin<Real, N> origin;
};

template <typename Real, std::size_t N>
RelativePose<Real, N> relativePose(const typename LagrangePlan<Real>::JointData& joint,
                                   const JointState<Real>& state,
                                   const std::array<Real, N>& multiplier) {
  const PositionNumber<Real, N> q = state.position(multiplier);
  const VelocityNumber<Real, N> qd = state.velocity(multiplier);
  const PositionNumber<Real, N> sine = composed(state.sine, state.cosine, q);
  const PositionNumber<Real, N> cosine = composed(state.cosine, -state.sine, q);
  const VelocityNumber<Real, N> sine_dot = cosine * qd, cosine_dot = sine * qd * Real(-1);
  const bool slides = joint.type == JointType::kPrismatic;
  RelativePose<Real, N> pose;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      PositionNumber<Real, N>& R = pose.orientation.R[i][j];
      VelocityNumber<Real, N>& Rdot = pose.orientation.Rdot[i][j];
      if (slides) {
        R = {joint.R_PK[i][j], 0, {}};
        Rdot = {};
      } else {
        R = sine * joint.sine[i][j] + cosine * joint.cosine[i][j] + joint.along[i][j];
        Rdot = sine_dot * joint.sine[i][j] + cosine_dot * joint.cosine[i][j];
      }
    }
    const Real axis = slides ? joint.axis_P[i] : Real(0);
    pose.origin.o[i] = q * axis + joint.p_PoKo_P[i];
    pose.origin.odot[i] = qd * axis;
  }
  return pose;
}

/// Orientation and origin of the child link; what a type of joint leaves constant is multiplied as
/// a constant where only the parent depends on the directions.
template <typename Real, std::size_t N>
Orientation<Real, N> childOrientation(const typename LagrangePlan<Real>::JointData& joint,
                                      const RelativePose<Real, 0>& pose,
                                      const Orientation<Real, N>& parent) {
  if (joint.type == JointType::kFixed || joint.type == JointType::kPrismatic) {
    return composed(parent, joint.R_PK);
  }
  return composed(parent, pose.orientation);
}

template <typename Real, std::size_t N, std::size_t M>
auto childOrigin(const typename LagrangePlan<Real>::JointData& joint,
                 const RelativePose<Real, 0>& pose, const Orientation<Real, N>& parent_axes,
                 const Origin<Real, M>& parent) {
  if (joint.type == JointType::kPrismatic) return composed(parent_axes, parent, pose.origin);
  return composed(parent_axes, parent, joint.p_PoKo_P);
}

/// The vector that is associated to the skew-symmetric matrix A^T B.
template <typename T, typename U>
auto skewVector(const Matrix<T>& A, const Matrix<U>& B) {
  using Product = decltype(A[0][0] * B[0][0]);
  return Triple<Product>{dot(column(A, 2), column(B, 1)), dot(column(A, 0), column(B, 2)),
                         dot(column(A, 1), column(B, 0))};
}

// --- generalized forces --------------------------------------------------------------------------

/// Left-hand side of (4.1): d/dt (dE / dsd) - dE/ds.
template <typename Real, std::size_t N>
std::array<Real, N> inertiaForce(const VelocityNumber<Real, N>& E) {
  return added(E.dsd_rate, scaled(Real(-1), E.ds));  // (4.1), left
}

template <typename Real, std::size_t N>
void add(const std::array<Real, N>& term, std::array<Real, N>& sum) {
  for (std::size_t i = 0; i < N; ++i) sum[i] += term[i];
}

/// Kinetic energy of the motion about the centre of mass, the terms in J of (5.5).
template <typename Real, std::size_t N>
VelocityNumber<Real, N> rotationEnergy(const Matrix<Real>& I, const Orientation<Real, N>& axes) {
  // (2.3): w~ = a da^T/dt = R^T dR/dt, so that no angular velocity is propagated.
  const Triple<VelocityNumber<Real, N>> w = skewVector(axes.R, axes.Rdot);
  return ((w[0] * w[0]) * I[0][0] + (w[1] * w[1]) * I[1][1] + (w[2] * w[2]) * I[2][2]) * Real(0.5) +
         ((w[0] * w[1]) * I[0][1] + (w[0] * w[2]) * I[0][2] + (w[1] * w[2]) * I[1][2]);
}

template <typename Real>
Triple<Real> transposed(const Matrix<Real>& A, const Triple<Real>& v) {
  return {dot(column(A, 0), v), dot(column(A, 1), v), dot(column(A, 2), v)};
}

template <typename Real, std::size_t N>
Matrix<Real> values(const Orientation<Real, N>& axes) {
  Matrix<Real> R;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R[i][j] = axes.R[i][j].value;
  }
  return R;
}

/// Virtual work of an applied wrench, by the displacement of its point and the rotation of its
/// link.
template <typename Real, std::size_t N, std::size_t M>
std::array<Real, M> virtualWork(const typename LagrangePlan<Real>::Applied& applied,
                                const Orientation<Real, N>& axes, const Origin<Real, M>& origin) {
  const Matrix<Real> R = values(axes);
  const Triple<Real> force = applied.in_root_axes ? applied.force : R * applied.force;
  std::array<Real, M> work = dot(origin.o + axes.R * applied.at, force).ds;
  if constexpr (N > 0) {
    const Triple<Real> torque =
        applied.in_root_axes ? transposed(R, applied.torque) : applied.torque;
    const Triple<PositionNumber<Real, N>> rotation{dot(column(axes.R, 1), column(R, 2)),
                                                   dot(column(axes.R, 2), column(R, 0)),
                                                   dot(column(axes.R, 0), column(R, 1))};
    add(dot(rotation, torque).ds, work);
  }
  return work;
}

/// What one link adds to the generalized force of each direction: (4.1) and (4.2) solved for it.
template <typename Real, std::size_t N, std::size_t M>
std::array<Real, M> linkForce(const typename LagrangePlan<Real>::LinkData& link,
                              const Triple<Real>& gravity, const Orientation<Real, N>& axes,
                              const Origin<Real, M>& origin) {
  std::array<Real, M> force{};
  if (link.mass != 0) {
    const auto c = origin.o + axes.R * link.p_KoCm_K;
    const auto cdot = origin.odot + axes.Rdot * link.p_KoCm_K;
    add(inertiaForce(dot(cdot, cdot) * (link.mass / 2)), force);  // (4.1), E = m v_C^2 / 2
    add(scaled(-link.mass, dot(c, gravity).ds), force);           // (4.1), force function m g . c
  }
  if constexpr (N > 0) {
    if (link.has_inertia)
      add(inertiaForce(rotationEnergy(link.inertia_Cm_K, axes)), force);  // (4.1)
  }
  for (const auto& applied : link.applied) {
    add(scaled(Real(-1), virtualWork<Real>(applied, axes, origin)), force);  // (4.1), - Q
  }
  return force;
}

/// The function whose derivative is s (3 - s^2) / 2 with s held within [-1, 1], up to a constant.
template <typename Real>
VelocityNumber<Real, 1> frictionPotential(const VelocityNumber<Real, 1>& s) {
  if (s.value >= 1 || s.value <= -1) return s * Real(s.value > 0 ? 1 : -1);
  const VelocityNumber<Real, 1> squared = s * s;
  return squared * (squared * (Real(-1) / 8) + Real(3) / 4);
}

/// Generalized force of what acts in a joint: of its spring, constant effort and rotor, and of
/// damping and friction by a dissipation function of Rayleigh's.
template <typename Real>
Real termsForce(const ResolvedJointTerms& terms, const JointState<Real>& state, Real multiplier) {
  const std::array<Real, 1> along{multiplier};
  const PositionNumber<Real, 1> stretch = state.position(along) + -Real(terms.rest);
  const VelocityNumber<Real, 1> qd = state.velocity(along), squared = qd * qd;
  const Real v = terms.coulomb_velocity;
  const VelocityNumber<Real, 1> E = squared * (Real(terms.rotor_inertia) / 2);
  const PositionNumber<Real, 1> force_function =
      (stretch * stretch) * (-Real(terms.stiffness) / 2) + stretch * -Real(terms.offset);
  const VelocityNumber<Real, 1> dissipation =
      squared * (Real(terms.damping) / 2) +
      frictionPotential(qd * (1 / v)) * (Real(terms.coulomb) * v);
  return inertiaForce(E)[0] - force_function.ds[0] + dissipation.dsd[0];  // (4.1)
}

// --- fictitious mobility -------------------------------------------------------------------------

/// Fictitious mobility (4.2) of three displacements along the axes, which are zero in the motion as
/// their velocities are.
template <typename Real>
Origin<Real, 3> fictitiousDisplacement() {
  Origin<Real, 3> origin{};
  for (std::size_t i = 0; i < 3; ++i) {
    origin.o[i].ds[i] = 1;
    origin.odot[i].dsd[i] = 1;
  }
  return origin;
}

/// Fictitious mobility (4.2) of three successive rotations about the axes, (2.2), which are zero in
/// the motion as their velocities are. To first order in s, and that is all that is differentiated,
/// their order does not matter: R = 1 + [s]x.
template <typename Real>
Orientation<Real, 3> fictitiousRotation() {
  Orientation<Real, 3> axes{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    axes.R[i][i].value = 1;
    axes.R[k][j].ds[i] = axes.Rdot[k][j].dsd[i] = 1;  // (2.2), to first order
    axes.R[j][k].ds[i] = axes.Rdot[j][k].dsd[i] = -1;
  }
  return axes;
}

}  // namespace virtual_work_dynamics
