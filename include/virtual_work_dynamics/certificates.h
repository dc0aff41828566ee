#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// By how much efforts and reactions of one sample miss laws that hold for the mechanism as a
/// whole, relative to the sum of the magnitudes of all terms: some 1e-15 when they are right, at
/// any scale. Zero where there is nothing to compare. They judge the arithmetic, not the motion and
/// the description that it starts from: see Deviations for these.
struct Certificates {
  double power = 0;          ///< efforts * velocities against the rate of change of energy
  double ground_force = 0;   ///< ground's force against the rate of change of momentum
  double ground_moment = 0;  ///< ground's moment against the rate of change of angular momentum

  /// The largest of the three; NaN when one of them is.
  double largest() const;
};

/// Certifies samples: carries velocities and accelerations of all centres of mass to root axes in a
/// way of its own, sums up momentum and energy, and compares. One instance serves one thread.
class Certifier {
 public:
  /// @throws SceneError as InverseDynamics does for applied wrenches and joint terms.
  Certifier(const Mechanism& mechanism, const Scene& scene);
  ~Certifier();
  Certifier(Certifier&&) noexcept;
  Certifier& operator=(Certifier&&) noexcept;

  /// Returns `request` with what certificates need added: efforts, and the reaction of ground in
  /// child axes, last of all unless it is asked for already.
  static Request extended(Request request);
  /// Index of the reaction of ground in Request::child_axes of an extended request.
  static std::size_t groundIndex(const Request& extended);

  /// Certificates of the results of one sample. Does not allocate.
  /// @param effort of every generalized coordinate, N m or N
  /// @param ground wrench of ground on the root link, root axes, about the root link's origin
  /// @throws MotionError when a vector has the wrong length.
  Certificates check(const Motion& motion, const Eigen::VectorXd& effort, const Wrench& ground);

  /// Certifies results that were computed with `load` in place of the values of the scene's applied
  /// wrenches. @throws SceneError when it has not one wrench for each of them.
  Certificates check(const Motion& motion, const Load& load, const Eigen::VectorXd& effort,
                     const Wrench& ground);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
