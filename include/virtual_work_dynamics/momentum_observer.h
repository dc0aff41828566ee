#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The generalized momentum observer of De Luca and Mattone (2003, 2005): external efforts at the
/// coordinates from positions, velocities and measured efforts, without accelerations. Where an
/// external effort is constant, the estimate follows it as a first-order low-pass with the time
/// constant 1 / gain.
///
/// Signs: what the joints' actuators and the outside exert together moves the tree, tau_motor +
/// tau_ext = tau_tree, so an external effort is the computed one less the measured one.
///
/// With the momentum p = M(q) qd, Lagrange's equations are p' = tau_motor + tau_ext + beta, where
/// beta = 1/2 qd^T (dM/dq) qd - g(q), less friction. The integral of tau_ext from one sample to the
/// next, of length h, is p_1 - p_0 less that of tau_motor + beta, by trapezoids; the estimate r
/// goes to its mean by r_1 = e^(-K h) r_0 + (1 - e^(-K h)) mean, which is exact for a constant
/// tau_ext whatever the lengths of the steps. Serves one thread. step() does not allocate.
class MomentumObserver {
 public:
  /// @param gain K, 1/s, positive
  /// @throws SceneError naming what it does not know: closed loops, joints that turn freely and
  ///   static scenes; and as Dynamics does.
  MomentumObserver(const Mechanism& mechanism, const Scene& scene, double gain);
  ~MomentumObserver();
  MomentumObserver(MomentumObserver&&) noexcept;
  MomentumObserver& operator=(MomentumObserver&&) noexcept;

  /// Takes a sample, later than the one before. Accelerations of the joints are not looked at; of a
  /// root that moves, its orientation, angular velocity and acceleration are.
  /// @param time s
  /// @param load of the sample, with one wrench for each applied wrench of the scene
  /// @param measured efforts of the actuators by coordinate, N m or N; NaN: not known
  void step(double time, const Motion& motion, const Load& load, const Eigen::VectorXd& measured);
  /// Forgets everything, as at a gap: the next sample is the first one.
  void restart();

  /// External efforts by coordinate, N m or N; zero at the first sample with a measured effort, NaN
  /// where that is not known.
  const Eigen::VectorXd& external() const;
  /// The momentum of the sample taken last, by coordinate, N m s or N s.
  const Eigen::VectorXd& momentum() const;
  /// beta of the sample taken last: what changes the momentum besides actuators and the outside.
  const Eigen::VectorXd& momentumRate() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
