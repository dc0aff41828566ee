#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "link_motions.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The balance of power of a mechanism: rates of change of its kinetic energy and of its height in
/// the gravity field, from positions and velocities alone. Both are written as functions of time
/// along q(t) = q + qd t + qdd t^2 / 2 and differentiated automatically. No acceleration of any
/// body, and no force, enters.
struct PowerBalance {
  long double kinetic = 0;  ///< dT/dt, W
  long double gravity = 0;  ///< power of the weights, W
  long double active = 0;   ///< sum of effort * qd, W
  long double scale = 0;    ///< sum of |effort * qd| and of the magnitudes above, W

  PowerBalance(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
               const Eigen::VectorXd& effort) {
    const Rated T = energies(mechanism, scene, motion, gravity_work_);
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
  static Rated energies(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                        Rated& gravity_work) {
    const std::vector<LinkMotion<Rated>> moves = linkMotions(mechanism, motion);
    const Vector3l g = scene.gravity.cast<long double>();
    Rated T(0);
    gravity_work = Rated(0);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const LinkMotion<Rated>& move = moves[i];
      const Link& link = mechanism.links()[i];
      const V3<Rated> r_C = move.R * constant<Rated>(link.p_KoCm_K);
      const V3<Rated> v_C = move.v + crossed<Rated>(move.w, r_C);
      const V3<Rated> w_link = move.R.transpose() * move.w;
      const V3<Rated> angular = constant<Rated>(link.inertia_Cm_K) * w_link;
      T += Rated(link.mass / 2) * v_C.dot(v_C) + Rated(0.5L) * w_link.dot(angular);
      gravity_work += Rated(link.mass) * (move.o + r_C).dot(constant<Rated>(g));
    }
    return T;
  }

  Rated gravity_work_;
};

}  // namespace virtual_work_dynamics
