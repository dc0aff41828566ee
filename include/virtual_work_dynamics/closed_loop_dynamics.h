#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/plan_summary.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

struct LoopSolvers;
class GivenLoops;

/// Inverse dynamics of a mechanism with closures (3.1)-(3.4): the tree by InverseDynamics, its
/// loops by multipliers, tau_tree = S^T tau + A^T lambda, and the reactions by (3.8) with the
/// wrench of each closure applied to both of its links. It takes everything in a scene, including
/// closures, springs and actuated joints. Immutable: one instance may serve any number of threads,
/// each with a workspace of its own. Dynamics serves mechanisms with and without loops.
class ClosedLoopDynamics {
 public:
  class Workspace;

  /// Compiles mechanism, scene and request into a plan. `request` names joints, closures and
  /// "ground".
  /// @throws SceneError naming what is wrong with closures, springs, actuated joints, assembly or
  ///   redundancy; naming the closure, and by how much it stays open, when the closures cannot be
  ///   assembled from the given start; and when the actuated joints are too few for the degrees of
  ///   freedom.
  ClosedLoopDynamics(const Mechanism& mechanism, const Scene& scene, const Request& request);
  ~ClosedLoopDynamics();
  ClosedLoopDynamics(ClosedLoopDynamics&&) noexcept;
  ClosedLoopDynamics& operator=(ClosedLoopDynamics&&) noexcept;

  /// Number of generalized coordinates: the length of q, qd and qdd.
  Eigen::Index coordinates() const;
  /// Number of orientations of a motion, see Mechanism::orientations().
  std::size_t orientations() const;
  const Request& request() const;
  /// The assembled position that the scene's start leads to.
  const Eigen::VectorXd& assembly() const;
  /// The longest way of a coordinate from the scene's start to the assembly, rad or over the size
  /// of the loops.
  double assemblyWay() const;
  /// Says in a line each which coordinates are assembled more than 1.5 rad, or the size of the
  /// loops, from their start: perhaps on another branch.
  std::vector<std::string> assemblyDoubts() const;
  /// Whether each generalized coordinate is actuated, or counts so as its effort is a residual.
  const std::vector<bool>& actuated() const;
  /// Whether the effort of each generalized coordinate is the residual of a free motion, see
  /// Scene::free_motion: the generalized force, N m or N, that the motion demands there beyond what
  /// the actuators can give, tau_tree along the motion that moves this coordinate by one and the
  /// other residual and actuated ones by zero. It vanishes where the mechanism moves freely. The
  /// coordinates are chosen once, close to the assembly.
  const std::vector<bool>& residual() const;
  /// What motions give, as the scene says: the actuated coordinates unless it says otherwise.
  const Given& given() const;
  /// Names of the actuated closures, whose efforts come after those of the coordinates, and before
  /// those of the couplings.
  const std::vector<std::string>& actuatedClosures() const;

  /// Names of the closures whose force can act one way only: what presses on a plane, and cables.
  /// A result that asks for the opposite is reported as it is, and flagged: see LoopResults::holds.
  /// Contacts that are open have no force and hold.
  const std::vector<std::string>& oneSided() const;

  /// What is wrong with a choice of what motions give, found in a regular position.
  struct GivenFinding {
    Eigen::Index freedom = 0;               ///< how many more coordinates would have to be given
    std::vector<std::string> undetermined;  ///< coordinates that would not follow
    std::vector<std::string> follow;        ///< what is given although it follows from the rest
  };
  /// Judges what motions give. Allocates.
  /// @throws SceneError when no joint moves a link whose pose is given.
  GivenFinding judge(const Given& given) const;

  /// The tree that is left when closures, springs and couplings are cut. What closures and springs
  /// exert becomes applied wrenches after the scene's own, with the values of
  /// LoopResults::tree_wrenches, so that Certifier, LagrangeDynamics and ErrorBound, which do not
  /// know loops, can be made from this scene. Its efforts are Results::treeEffort().
  const Scene& tree() const;

  /// What a sample of the tree without closures and springs costs. Allocates; runs the recursion
  /// once.
  PlanSummary summary() const;

  /// Makes the memory for complete() and compute(). Allocates, so that these do not.
  Workspace makeWorkspace() const;

  /// Replaces the passive coordinates of `motion` by those that the closures demand: positions by
  /// Newton's method from those in `motion` (the previous sample's), velocities and accelerations
  /// by the conditions. Returns false when the loops cannot be closed there, when the given
  /// velocities or accelerations contradict them, and where they do not determine the others, as in
  /// a singular position; positions are then the best met, and rates are not usable. Does not
  /// allocate.
  /// @throws MotionError when a vector of `motion` has the wrong length, or the workspace is
  ///   another plan's.
  bool complete(Motion& motion, Workspace& workspace) const;
  /// Completes from a position close by, such as that of an earlier sample: where the loops cannot
  /// be closed, the search ends as soon as it makes no more progress. Throws what complete()
  /// throws.
  bool completeFromCloseBy(Motion& motion, Workspace& workspace) const;
  /// Complete a motion that gives other coordinates than the actuated ones. Throw what complete()
  /// throws.
  /// @throws MotionError unless `given` has one entry for each coordinate.
  bool complete(Motion& motion, const std::vector<bool>& given, Workspace& workspace) const;
  bool completeFromCloseBy(Motion& motion, const std::vector<bool>& given,
                           Workspace& workspace) const;
  /// Whether a position lets the coordinates that are given determine the others: a singular one
  /// does not. Throws what complete() throws.
  bool determine(const Eigen::VectorXd& q, const std::vector<bool>& given,
                 Workspace& workspace) const;

  /// How far a motion violates each closure, then each coupling: what LoopResults::residuals and
  /// relative_residuals are where Request::residuals leaves them out.
  struct Residuals {
    std::vector<ClosureResidual> plain, relative;
  };
  /// Finds these of one sample; the workspace's results stay. Allocates what it returns.
  /// @throws MotionError when compute() would.
  Residuals residualsOf(const Motion& motion, Workspace& workspace) const;

  /// Computes efforts and reactions of one sample into the workspace. Does not allocate.
  /// @throws MotionError when a vector of `motion` has the wrong length, or the workspace is
  ///   another plan's.
  void compute(const Motion& motion, Workspace& workspace) const;
  /// Computes with `load` in place of the values of the scene's applied wrenches.
  /// @throws SceneError unless `load` has one wrench for each of them.
  void compute(const Motion& motion, const Load& load, Workspace& workspace) const;

 private:
  friend class Dynamics;
  friend class LoopRows;
  friend class SamplePack;
  struct Impl;
  void requireGiven(const std::vector<bool>& given) const;
  std::unique_ptr<GivenLoops> givenLoops(const Given& given) const;
  std::unique_ptr<const Impl> impl_;
};

/// Results and scratch memory of one thread's computations; made by
/// ClosedLoopDynamics::makeWorkspace(), whose maker must outlive it.
class ClosedLoopDynamics::Workspace {
 public:
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  /// Results of the sample computed last. The reaction of a closure is what its parent exerts on
  /// its child, about the child frame's origin; its child axes are that frame's axes.
  const Results& results() const;

 private:
  friend class ClosedLoopDynamics;
  friend class LoopRows;
  struct Impl;
  explicit Workspace(const ClosedLoopDynamics::Impl& plan);
  LoopSolvers& solversOf(const ClosedLoopDynamics::Impl& plan);
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
