#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Inverse dynamics of a mechanism with closures (3.1)-(3.4): the tree by InverseDynamics, its
/// loops by multipliers, tau_tree = S^T tau + A^T lambda, and the reactions by (3.8) with the
/// wrench of each closure applied to both of its links. Everything of a scene: closures, springs,
/// actuated joints. One instance serves one thread.
class ClosedLoopDynamics {
 public:
  /// `request` names joints, closures and "ground".
  /// @throws SceneError naming what is wrong with closures, springs, actuated joints, assembly or
  ///   redundancy; when the closures cannot be assembled from the given start, by how much and
  ///   which; and when actuated joints are too few for the degrees of freedom.
  ClosedLoopDynamics(const Mechanism& mechanism, const Scene& scene, const Request& request);
  ~ClosedLoopDynamics();
  ClosedLoopDynamics(ClosedLoopDynamics&&) noexcept;
  ClosedLoopDynamics& operator=(ClosedLoopDynamics&&) noexcept;

  Eigen::Index coordinates() const;
  const Request& request() const;
  /// The assembled position that the scene's start leads to.
  const Eigen::VectorXd& assembly() const;
  /// Whether each generalized coordinate is actuated.
  const std::vector<bool>& actuated() const;
  /// Names of actuated closures, whose efforts follow those of the coordinates.
  const std::vector<std::string>& actuatedClosures() const;
  /// How far each of them has turned, within half a turn, or slid, and how fast, in the motion
  /// computed last; rad or m.
  const Eigen::VectorXd& actuatedClosurePositions() const;
  const Eigen::VectorXd& actuatedClosureVelocities() const;

  /// Replaces the passive coordinates of `motion` by those that the closures demand: positions by
  /// Newton's method from those in `motion` (the previous sample's), velocities and accelerations
  /// by the conditions. False when the loops cannot be closed there, when the given velocities or
  /// accelerations contradict them, and where they do not determine the others, as in a singular
  /// position; positions are then the best met, rates are of no use. Does not allocate.
  /// @throws MotionError when a vector of `motion` has the wrong length.
  bool complete(Motion& motion);
  /// The same from a position close by, as one of the samples before: where the loops cannot be
  /// closed, the search ends as soon as it gets no further.
  /// @throws MotionError when a vector of `motion` has the wrong length.
  bool completeFromCloseBy(Motion& motion);
  /// complete() with other coordinates given.
  /// @throws MotionError when `given` has not one entry for each coordinate.
  bool complete(Motion& motion, const std::vector<bool>& given);

  /// As Workspace::setAppliedWrench().
  void setAppliedWrench(std::size_t index, const Eigen::Vector3d& force,
                        const Eigen::Vector3d& torque);

  /// Efforts and reactions of one sample. Does not allocate.
  /// @throws MotionError when a vector of `motion` has the wrong length.
  void compute(const Motion& motion);

  /// Of each generalized coordinate, zero for passive ones, then of each actuated closure.
  const Eigen::VectorXd& effort() const;
  /// In the order of the request. Of a closure: what its parent exerts on its child, about the
  /// child frame's origin; child axes are that frame's.
  const std::vector<Wrench>& childAxes() const;
  const std::vector<Wrench>& rootAxes() const;
  const std::vector<Pose>& poses() const;
  const std::vector<Twist>& twists() const;
  bool finite() const;

  /// What of these is determined.
  const Determinacy& determinacy() const;
  const std::vector<bool>& effortDetermined() const;
  const std::vector<Determined>& childAxesDetermined() const;
  const std::vector<Determined>& rootAxesDetermined() const;

  /// By closure: Determinacy::condition of the loops that are solved together with its own.
  const std::vector<double>& closureConditions() const;

  /// The tree that is left when closures and springs are cut. What these exert are applied wrenches
  /// behind the scene's own, so that Certifier, LagrangeDynamics and ErrorBound, which know of no
  /// loops, can be made of it. Its efforts are those of the coordinates, without the actuated
  /// closures.
  const Scene& tree() const;
  /// Values of the wrenches behind the scene's own, of the motion computed last, root axes.
  const std::vector<Wrench>& treeWrenches() const;
  /// Hands them to what was made of tree().
  template <typename OfTree>
  void applyTo(OfTree& of_tree) const {
    const std::size_t own = tree().applied_wrenches.size() - treeWrenches().size();
    for (std::size_t i = 0; i < treeWrenches().size(); ++i) {
      of_tree.setAppliedWrench(own + i, treeWrenches()[i].force, treeWrenches()[i].torque);
    }
  }

  /// Of each closure, of the motion computed last.
  const std::vector<ClosureResidual>& residuals() const;
  /// The same without units, to be held against a tolerance: lengths over the size of the loops,
  /// velocities also over the largest rate of the motion, accelerations over its largest
  /// acceleration or the square of that rate. Rates below 1/s and accelerations below 1/s^2 count
  /// as these.
  const std::vector<ClosureResidual>& relativeResiduals() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
