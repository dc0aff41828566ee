#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <unsupported/Eigen/AutoDiff>
#include <vector>

#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Rate of change of a mechanism's kinetic energy and of its height in the gravity field, from
/// positions and velocities alone: both are written as functions of time along
/// q(t) = q + qd t + qdd t^2 / 2 and differentiated automatically. No acceleration of any body, and
/// no force, enters.
struct PowerBalance {
  long double kinetic = 0;  ///< dT/dt, W
  long double gravity = 0;  ///< power of the weights, W
  long double active = 0;   ///< sum of effort * qd, W
  long double scale = 0;    ///< sum of |effort * qd| and of the magnitudes above, W

  PowerBalance(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
               const Eigen::VectorXd& effort) {
    using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<long double, 1, 1>>;
    std::vector<Dual> q, qd;
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      q.emplace_back(motion.q[i], Eigen::Matrix<long double, 1, 1>(motion.qd[i]));
      qd.emplace_back(motion.qd[i], Eigen::Matrix<long double, 1, 1>(motion.qdd[i]));
    }
    const Dual T = energies<Dual>(mechanism, scene, q, qd, gravity_work_);
    kinetic = T.derivatives()[0];
    gravity = gravity_work_.derivatives()[0];
    scale = std::abs(kinetic) + std::abs(gravity);
    for (Eigen::Index i = 0; i < effort.size(); ++i) {
      active += static_cast<long double>(effort[i]) * motion.qd[i];
      scale += std::abs(static_cast<long double>(effort[i]) * motion.qd[i]);
    }
  }

  /// |active - (dT/dt - gravity)| over the sum of the terms' magnitudes.
  long double residual() const { return std::abs(active - kinetic + gravity) / scale; }

 private:
  using Dual1 = Eigen::AutoDiffScalar<Eigen::Matrix<long double, 1, 1>>;

  template <typename S>
  using V = Eigen::Matrix<S, 3, 1>;
  template <typename S>
  using M = Eigen::Matrix<S, 3, 3>;

  template <typename S>
  static V<S> crossed(const V<S>& a, const V<S>& b) {
    return V<S>(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  }

  template <typename S>
  static V<S> constant(const Vector3l& v) {
    return V<S>(S(v[0]), S(v[1]), S(v[2]));
  }

  template <typename S>
  static M<S> constant(const Matrix3l& A) {
    M<S> result;
    for (int i = 0; i < 9; ++i) result(i / 3, i % 3) = S(A(i / 3, i % 3));
    return result;
  }

  // Rodrigues' formula.
  template <typename S>
  static M<S> rotation(const Vector3l& u, const S& angle) {
    using std::cos;
    using std::sin;
    const S c = cos(angle), s = sin(angle);
    M<S> R;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const long double skew = i == j ? 0 : ((j - i + 3) % 3 == 1 ? -u[3 - i - j] : u[3 - i - j]);
        R(i, j) = S(u[i] * u[j]) + c * S((i == j) - u[i] * u[j]) + s * S(skew);
      }
    }
    return R;
  }

  template <typename S>
  static S energies(const Mechanism& mechanism, const Scene& scene, const std::vector<S>& q,
                    const std::vector<S>& qd, S& gravity_work) {
    const std::size_t n = mechanism.links().size();
    std::vector<M<S>> R(n, constant<S>(Matrix3l(Matrix3l::Identity())));
    std::vector<V<S>> o(n, constant<S>(Vector3l(Vector3l::Zero()))), v(o), w(o);
    const Vector3l g = scene.gravity.cast<long double>();
    S T(0);
    gravity_work = S(0);
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) {
        const Joint& joint = mechanism.joints()[i - 1];
        const std::size_t p = joint.parent_link;
        const M<S> R_joint = R[p] * constant<S>(joint.R_PK);
        const V<S> axis = R_joint * constant<S>(joint.axis_K);
        S position(0), rate(0);
        if (joint.coordinate >= 0) {
          position = q[joint.coordinate] * S(joint.multiplier) + S(joint.offset);
          rate = qd[joint.coordinate] * S(joint.multiplier);
        }
        V<S> r = R[p] * constant<S>(joint.p_PoKo_P);
        R[i] = R_joint;
        w[i] = w[p];
        V<S> slide = constant<S>(Vector3l(Vector3l::Zero()));
        if (joint.type == JointType::kPrismatic) {
          r += axis * position;
          slide = axis * rate;
        } else if (joint.coordinate >= 0) {
          R[i] = R_joint * rotation<S>(joint.axis_K, position);
          w[i] = w[p] + axis * rate;
        }
        o[i] = o[p] + r;
        v[i] = v[p] + crossed<S>(w[p], r) + slide;
      }
      const Link& link = mechanism.links()[i];
      const V<S> r_C = R[i] * constant<S>(link.p_KoCm_K);
      const V<S> v_C = v[i] + crossed<S>(w[i], r_C);
      const V<S> w_link = R[i].transpose() * w[i];
      const V<S> angular = constant<S>(link.inertia_Cm_K) * w_link;
      T += S(link.mass / 2) * v_C.dot(v_C) + S(0.5L) * w_link.dot(angular);
      gravity_work += S(link.mass) * (o[i] + r_C).dot(constant<S>(g));
    }
    return T;
  }

  Dual1 gravity_work_;
};

}  // namespace virtual_work_dynamics
