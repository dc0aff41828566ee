#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Efforts and reactions by the paper's other formalism, Lagrange's equations (4.1) with a
/// fictitious mobility at the joint in question that is set to zero after differentiation (4.2): an
/// independent witness of InverseDynamics, whose results it should equal. Kinetic energy and force
/// function are written from positions and velocities alone and differentiated automatically, so
/// that no step size enters. Its cost grows with the square of the number of bodies: not for the
/// per-sample path. Real: double or long double. One instance serves one thread.
template <typename Real>
class LagrangeDynamics {
 public:
  /// Compiles efforts and reactions of the request; its poses and twists are ignored.
  /// @throws SceneError as InverseDynamics does.
  LagrangeDynamics(const Mechanism& mechanism, const Scene& scene, const Request& request);
  ~LagrangeDynamics();
  LagrangeDynamics(LagrangeDynamics&&) noexcept;
  LagrangeDynamics& operator=(LagrangeDynamics&&) noexcept;

  /// Number of generalized coordinates: the length of q, qd, qdd and of the effort.
  Eigen::Index coordinates() const;
  const Request& request() const;

  /// Computes all results of one sample. Does not allocate.
  /// @throws MotionError when a vector of `motion` has the wrong length.
  void compute(const Motion& motion);
  /// Computes with `load` in place of the values of the scene's applied wrenches.
  /// @throws SceneError when it has not one wrench for each of them.
  void compute(const Motion& motion, const Load& load);

  /// Results in the order of those of Workspace, rounded to double: efforts, N m or N.
  const Eigen::VectorXd& effort() const;
  /// Reactions of Request::child_axes.
  const std::vector<Wrench>& childAxes() const;
  /// Reactions of Request::root_axes, (4.3).
  const std::vector<Wrench>& rootAxes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
