#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Sums of the norms of all terms of a wrench, the yardstick Y of doc/theory.md: however much of
/// them cancels, rounding errors are parts of these.
struct WrenchMagnitude {
  double force = 0;   ///< N
  double moment = 0;  ///< N m
};

/// How large the terms are whose sums are efforts and reactions, and from them how far results may
/// be off: a recursion over norms instead of vectors. Velocities and accelerations are sums of
/// norms from the root on, forces (3.5) sums of the magnitudes of their products, carried to the
/// parent's origin by norm, moments by |p| |F|, (3.8). One instance serves one thread.
class ErrorBound {
 public:
  /// @throws SceneError as InverseDynamics does for applied wrenches and joint terms.
  ErrorBound(const Mechanism& mechanism, const Scene& scene);
  ~ErrorBound();
  ErrorBound(ErrorBound&&) noexcept;
  ErrorBound& operator=(ErrorBound&&) noexcept;

  /// Computes the magnitudes of one sample. Does not allocate. Fixed joints are joints like others.
  /// @param least magnitude that every number counts as at least. Rounding errors are relative down
  /// to the
  ///   smallest normal number of a number type, and below it as large as there: given that number,
  ///   the digits that denormal numbers lose are parts of the magnitudes, too.
  /// @throws MotionError when a vector of `motion` has the wrong length.
  void compute(const Motion& motion, double least = 0);
  /// Computes magnitudes with `load` in place of the values of the scene's applied wrenches.
  /// @throws SceneError when it has not one wrench for each of them.
  void compute(const Motion& motion, const Load& load, double least = 0);

  /// Magnitudes of the wrench on each link's origin: [0] of ground, [k + 1] of joint k.
  const std::vector<WrenchMagnitude>& wrenches() const;
  /// Magnitude of the effort of each generalized coordinate, mimic joints and joint terms included.
  const std::vector<double>& efforts() const;

  /// How many steps in sequence lie behind a wrench, L of doc/theory.md: joints on the longest path
  /// from the root through the joint to a leaf, plus the binary logarithms of the numbers of
  /// children on the joint's side of it, as hubs sum pairwise. The joints before it count, too: its
  /// orientation in the field of gravity is a product of their rotations. [0] of ground, [k + 1] of
  /// joint k.
  const std::vector<int>& depths() const;
  /// How many steps lie behind the effort of each generalized coordinate: the most of any joint
  /// that it moves.
  const std::vector<int>& effortDepths() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
