#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/instruction_set.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/plan_summary.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Begins the names of efforts that are residuals of free motions. That a name begins so says
/// nothing: a joint may be called so, see Dynamics::residuals().
constexpr const char* kMotionResidual = "residual.motion.";

/// Inverse dynamics of a mechanism, open or closed: efforts and reaction wrenches of a request. In
/// an open chain nothing has to be completed and everything is determined, and it pays nothing for
/// the other cases. Immutable: one instance may serve any number of threads, each with a workspace
/// of its own.
class Dynamics {
 public:
  class Workspace;

  /// Compiles mechanism, scene and request into a plan. `request` names joints, closures and
  /// "ground".
  /// @throws SceneError as InverseDynamics and ClosedLoopDynamics do, and when what the scene says
  ///   motions give does not determine the rest, or is too much; Error when the instruction
  ///   set is not supported.
  Dynamics(const Mechanism& mechanism, const Scene& scene, const Request& request,
           InstructionSet instruction_set = chosenInstructionSet());
  /// Compiles everything the scene asks for: efforts, and its reactions in both axes.
  Dynamics(const Mechanism& mechanism, const Scene& scene);
  ~Dynamics();
  Dynamics(Dynamics&&) noexcept;
  Dynamics& operator=(Dynamics&&) noexcept;

  /// Number of generalized coordinates: the length of q, qd and qdd.
  Eigen::Index coordinates() const;
  /// Number of orientations of a motion, see Mechanism::orientations().
  std::size_t orientations() const;
  const Request& request() const;
  /// Names of what has an effort: the coordinates, the actuated closures, the couplings. An effort
  /// that nothing delivers, see ClosedLoopDynamics::residual(), has kMotionResidual before the
  /// name.
  const std::vector<std::string>& effortNames() const;
  /// Whether each effort, in the order of effortNames(), is a residual that nothing delivers.
  const std::vector<bool>& residuals() const;

  /// Whether the scene has closures, springs between points, couplings or passive joints.
  bool closed() const;
  /// Names of the closures, then of the couplings, which have residuals; none in an open chain.
  const std::vector<std::string>& closureNames() const;
  /// See ClosedLoopDynamics::oneSided(); none in an open chain.
  const std::vector<std::string>& oneSided() const;
  /// How messages name one of these: "closure 'pin'", "coupling 'wrist'". Allocates.
  std::string closureLabel(std::size_t i) const;
  /// Number of couplings, whose efforts are the last.
  std::size_t couplings() const;
  /// Whether each generalized coordinate is actuated; in an open chain all are.
  const std::vector<bool>& actuated() const;
  /// What motions give, as the scene says. Unless it says anything, these are the actuated
  /// coordinates, and all where a closure is actuated.
  const Given& given() const;
  /// See ClosedLoopDynamics::judge(); in an open chain nothing is wrong. Allocates.
  ClosedLoopDynamics::GivenFinding judge(const Given& given) const;
  /// Whether the closures determine the motion of passive joints from that of the actuated ones:
  /// there are closures or couplings, no closure is actuated, and all have positions, which wheels
  /// and blades have not.
  bool closuresDetermine() const;
  /// The position in which the loops are assembled; zero in an open chain.
  const Eigen::VectorXd& assembly() const;
  /// See ClosedLoopDynamics::assemblyWay(); 0 in an open chain.
  double assemblyWay() const;
  /// See ClosedLoopDynamics::assemblyDoubts(); none in an open chain.
  std::vector<std::string> assemblyDoubts() const;

  /// The mechanism as a tree, for Certifier, LagrangeDynamics and ErrorBound, which do not know
  /// loops: an open chain's own scene, or what is left when closures and springs are cut, with
  /// applied wrenches in their places. Its efforts are those of the coordinates.
  const Scene& tree() const;
  /// The efforts and reactions of the request that the tree has, in its order.
  const Request& treeRequest() const;
  /// Gets the wrenches that act on the tree in a sample: LoopResults::tree_wrenches, or the scene's
  /// applied wrenches.
  /// @param results of this plan, computed with the scene's own load
  /// @param load receives the values; the call does not allocate when it has as many wrenches as
  ///   tree()
  void getTreeLoad(const Results& results, Load& load) const;
  /// Gets the wrenches of results that were computed with the load `given`.
  void getTreeLoad(const Results& results, const Load& given, Load& load) const;

  /// What a sample costs, and what was left out. With closed loops it is that of the tree without
  /// closures and springs, as the rest depends on the position. Allocates; runs the recursion once.
  PlanSummary summary() const;

  /// Makes the memory for complete() and compute(). Allocates, so that these do not.
  Workspace makeWorkspace() const;

  /// Replaces the passive coordinates of `motion` by those that the closures demand; see
  /// ClosedLoopDynamics::complete(). Returns true at once in an open chain. Does not allocate.
  /// @throws MotionError when a vector of `motion` has the wrong length, or the workspace is
  ///   another plan's.
  bool complete(Motion& motion, Workspace& workspace) const;
  /// Completes from a position close by; see ClosedLoopDynamics::completeFromCloseBy().
  bool completeFromCloseBy(Motion& motion, Workspace& workspace) const;
  bool completeFromCloseBy(Motion& motion, const std::vector<bool>& given,
                           Workspace& workspace) const;
  /// Why a motion could not be completed, in one line: the closure that stays open furthest at its
  /// position, that the position is singular, or that the rates contradict the closures. Allocates.
  /// @param motion as complete() left it
  /// @param given the coordinates that it was completed from; the actuated ones if they are left
  /// out
  std::string whyOpen(const Motion& motion, const std::vector<bool>& given,
                      Workspace& workspace) const;
  std::string whyOpen(const Motion& motion, Workspace& workspace) const;

  /// Computes efforts and reactions of one sample into the workspace. Does not allocate. Costs less
  /// when complete() has left the workspace at the position already.
  /// @throws MotionError when a vector of `motion` has the wrong length, or the workspace is
  ///   another plan's.
  void compute(const Motion& motion, Workspace& workspace) const;
  /// Computes with `load` in place of the values of the scene's applied wrenches.
  /// @throws SceneError unless `load` has one wrench for each of them.
  void compute(const Motion& motion, const Load& load, Workspace& workspace) const;

 private:
  friend class SampleRows;
  friend class Deviations;
  friend class MotionFit;
  friend class PassiveJoints;
  struct Impl;
  std::unique_ptr<GivenLoops> givenLoops(const Given& given) const;
  std::unique_ptr<const Impl> impl_;
};

/// Results and scratch memory of one thread's computations; made by Dynamics::makeWorkspace(),
/// whose maker must outlive it.
class Dynamics::Workspace {
 public:
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  /// Results of the sample computed last.
  const Results& results() const;

 private:
  friend class Dynamics;
  friend class SampleRows;
  struct Impl;
  explicit Workspace(const Dynamics::Impl& plan);
  Impl& memoryFor(const Dynamics::Impl& plan);
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
