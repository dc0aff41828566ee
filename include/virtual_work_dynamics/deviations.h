#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Standard deviations of the results of one sample, in the order of the Request. A result has none
/// (NaN) where it does not exist, where rigid-body mechanics does not determine it, and where the
/// covariance is not finite.
struct StandardDeviations {
  Eigen::VectorXd effort;          ///< as Results::effort, N m or N; at least zero
  std::vector<Wrench> child_axes;  ///< of each component, N and N m
  std::vector<Wrench> root_axes;   ///< of each component, N and N m
};

/// What is uncertain of the motion of a coordinate.
enum class MotionLevel { kPosition, kVelocity, kAcceleration };
constexpr int kMotionLevels = 3;

/// Covariances of the applied wrenches of a scene as their AppliedWrench::deviation says; zero
/// where there is none.
std::vector<WrenchCovariance> wrenchCovariances(const Scene& scene);

/// Propagates what is not known of a sample's motion, and of a scene's masses and inertias, to its
/// efforts and reactions, each share for itself.
///
/// The share of the motion is J C J^T. The columns of J are differences between the sample and
/// others in which one position, velocity or acceleration is shifted, 3 n + 1 samples for n
/// coordinates. Each is shifted by its own standard deviation, so that what is not linear within
/// it counts as far as the noise reaches: dry friction where a joint turns back, and the force that
/// presses toothed wheels apart, which has the amount of what the teeth bear on whichever flank.
/// Velocities are shifted towards zero. Positions are shifted by 1e-6 to 1e-3 rad or m and
/// velocities by at least 1e-6 of themselves or 1e-6 rad/s or m/s, so that neither tiny deviations
/// lose digits nor large ones leave the position; the differences are divided by the shifts.
/// Without teeth that press, results are linear in accelerations and wrenches, and any shift
/// serves.
///
/// In closed loops a motion has only as many independent coordinates as the closures leave. Where
/// the closures determine the passive joints, the actuated ones are shifted, and the others follow.
/// Otherwise independent coordinates are chosen, actuated ones first. The covariances of the
/// coordinates that follow are not used: their noise is what the others' noise makes of it, as a
/// motion must close the loops. Where wheels, blades and couplings tie rates alone, coordinates
/// whose rates follow may have positions that do not, which are shifted by themselves.
///
/// Where the root moves, the twelve numbers of RootCovariance are shifted, too, and of each wrench
/// that the scene gives a deviation the six of WrenchCovariance. Of joints that turn freely,
/// covariances of their turns may be given in place of those of their angles. Where another link
/// tells how the root moves, MotionCovariance::root_link, the root's motion follows from that
/// link's and the joints' in each sample.
///
/// The share of the description is the root of the sum of squares of what each link's mass and
/// inertia contribute, times their tolerance: efforts are linear in both, and so are reactions,
/// except where teeth press wheels apart. There each mass and inertia is larger by its tolerance,
/// and what differs counts; beside live wrenches, which this share does not know, reactions of the
/// teeth and of the joints between their wheels have none, nor has any reaction under a redundancy
/// policy other than the default. The centre of mass and the moments' proportions count as known.
///
/// Immutable: one instance may serve any number of threads, each with a workspace of its own.
class Deviations {
 public:
  class Workspace;

  /// Compiles plans for what is requested; poses and twists are ignored.
  /// @throws SceneError as Dynamics does, and for tolerances that are not from 0 to below 1.
  Deviations(const Mechanism& mechanism, const Scene& scene, const Request& request);
  ~Deviations();
  Deviations(Deviations&&) noexcept;
  Deviations& operator=(Deviations&&) noexcept;

  /// Number of generalized coordinates.
  Eigen::Index coordinates() const;
  /// Names of what has an effort, as Dynamics::effortNames().
  const std::vector<std::string>& effortNames() const;
  /// Whether each of them is a residual, as Dynamics::residuals().
  const std::vector<bool>& residuals() const;
  /// Whether the scene has tolerances, and so the description a share.
  bool hasTolerances() const;
  /// Whether a coordinate is shifted by itself; the others follow from the closures.
  const std::vector<bool>& independent() const;

  /// Memory for the computations. Allocates, so that they do not.
  Workspace makeWorkspace() const;

  /// Computes the share of the motion. Does not allocate.
  /// @param motion of all coordinates, as Dynamics::compute() takes it
  /// @param covariance of the motion, and of the scene's wrenches
  /// @throws MotionError when a vector of `motion` or the covariance has the wrong length, or the
  ///   workspace is another plan's.
  void computeMotion(const Motion& motion, const MotionCovariance& covariance,
                     Workspace& workspace) const;
  /// Computes the share of the motion with another load than the scene's. Does not allocate, unless
  /// `law` does.
  void computeMotion(const Motion& motion, const MotionCovariance& covariance, const LoadLaw& law,
                     Workspace& workspace) const;
  /// Computes the share of the description, which is zero without tolerances. Does not allocate.
  /// @throws MotionError when a vector of `motion` has the wrong length, or the workspace is
  ///   another plan's.
  void computeDescription(const Motion& motion, Workspace& workspace) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// Results and scratch memory of one thread's computations; made by Deviations::makeWorkspace(),
/// whose maker must outlive it.
class Deviations::Workspace {
 public:
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  /// The share of the motion, as computed last.
  const StandardDeviations& motion() const;
  /// The share of the description, as computed last.
  const StandardDeviations& description() const;
  /// The part of each effort's variance that each level of each coordinate's motion would make by
  /// itself: rows are efforts, columns kMotionLevels * coordinate + level. Where the root moves,
  /// four columns follow: its orientation, angular velocity, angular acceleration and acceleration;
  /// then one for each wrench that has a deviation. Of the motion computed last.
  const Eigen::MatrixXd& effortParts() const;

 private:
  friend class Deviations;
  struct Impl;
  explicit Workspace(const Deviations::Impl& plan);
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
