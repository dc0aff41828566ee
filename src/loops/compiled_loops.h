#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "loops/completion.h"
#include "loops/force_ranges.h"
#include "loops/forces.h"
#include "loops/groups.h"
#include "loops/holds.h"
#include "loops/kinematics.h"
#include "loops/point_springs.h"
#include "loops/reactions.h"
#include "loops/residuals.h"
#include "loops/spring_reach.h"
#include "scene/couplings.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// The solvers of all groups of loops, at one position. Serves one thread.
struct LoopSolvers {
  /// `mechanism`, `loops` and `groups` must outlive it.
  /// @param start where they begin; copied
  /// @param length of the loops, m
  LoopSolvers(const Mechanism& mechanism, const LoopScene& loops,
              const std::vector<LoopGroup>& groups, const LoopKinematics& start, double length);
  LoopSolvers(const LoopSolvers&) = delete;  // forces refer to kinematics

  LoopKinematics kinematics;
  LoopCompletion completion;
  std::vector<LoopForces> forces;  // by group
  LoopResiduals residuals;
};

/// The compiled form of a ClosedLoopDynamics; it does not change after construction.
struct ClosedLoopDynamics::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& wanted);
  Impl(const Impl&) = delete;  // solvers refer to it

  Request request;
  Mechanism mechanism;
  bool static_motion;
  LoopScene loops;
  std::vector<ResolvedCoupling> couplings;
  PointSprings springs;
  Scene bare_tree;  // without closures, springs and couplings
  Scene tree;
  std::size_t own_wrenches;  // number of the scene's own, the tree's first
  Load own_load;             // values of the scene's own wrenches
  bool reacts;               // whether reactions are requested
  bool moves;                // whether results depend on how links and closures move
  std::size_t closures;
  std::vector<std::string> closure_names, actuated_closures;
  LoopKinematics kinematics;  // at the assembly
  std::vector<LoopGroup> groups;
  LoopHolds holds;
  std::vector<SpringReach> reach;  // by spring
  std::vector<int> open_efforts;   // actuated coordinates in no loop, whose efforts are the tree's
  double length = 1;
  Eigen::VectorXd assembly;
  double way = 0;  // from the scene's start, rad or over the length
  std::unique_ptr<LoopReactions> child_axes, root_axes;  // to be copied
  std::unique_ptr<InverseDynamics> tree_pass;            // efforts and reactions without closures
  std::unique_ptr<InverseDynamics> weighed_pass;  // reactions that the policy weighs, or null
  std::vector<int> weighed_joints;
  /// What regular positions leave open of a reaction, in some axes; see LoopResults::effort_exists.
  struct UsuallyOpen {
    Determined determined = kAllComponents;
    int components = 0;  ///< how many are not determined
    int dimensions = 0;  ///< of the changes of the wrench, whatever the axes
  };
  std::vector<UsuallyOpen> child_axes_usual, root_axes_usual;

 private:
  void close(const Scene& scene);
  void chooseResidual(const Scene& scene);
  void requireSprings(LoopSolvers& solvers) const;
  void setUsual();
  static std::vector<UsuallyOpen> usuallyOpen(const std::vector<Determined>& determined,
                                              const std::vector<int>& ranks);
};

/// The scratch memory of one thread.
struct ClosedLoopDynamics::Workspace::Impl {
  explicit Impl(const ClosedLoopDynamics::Impl& compiled);

  void compute(const Motion& motion, const Load& load);
  /// Finishes a sample whose solutions the solvers have, with efforts and reactions of the open
  /// tree and a load without springs.
  void finish(const Load& load, const virtual_work_dynamics::Workspace& tree);
  /// Exchanges the results for others of this plan, whatever sample these are of.
  void exchange(Results& others) {
    std::swap(results, others);
    all_exist_ = false;
  }
  /// The effort, by place in Results, of a set of a group that is no closure's.
  std::size_t effortOf(const LoopForces& group, std::size_t local) const;
  /// Sets the flags and the ranks below, of the sample computed last.
  void setDetermined();
  void setRanks();

  const ClosedLoopDynamics::Impl& plan;
  LoopSolvers solvers;
  Results results;
  /// Which results are determined: those of LoopResults, also where these are not requested.
  struct Flags {
    std::vector<bool> effort;
    std::vector<Determined> child_axes, root_axes;
  };
  Flags determined;
  /// How many dimensions the changes of each reaction span that mechanics leaves open.
  std::vector<int> child_axes_ranks, root_axes_ranks;

 private:
  void move(const Motion& motion);
  void push(const Motion& motion, const Load& load);
  void report();
  void collect();
  void react();
  void addClosures(const LoopReactions& reactions, const std::vector<Wrench>& tree,
                   std::vector<Wrench>& values) const;
  void setActuatedClosures();
  void setCouplings();
  void publishFlags();
  void setExistence();
  void leaveOutSprings();
  void setDeterminacy();

  const LoopFunctions* kernel_;
  virtual_work_dynamics::Workspace tree_;
  const virtual_work_dynamics::Workspace* pushed_ = &tree_;  // of the sample
  std::optional<virtual_work_dynamics::Workspace> weighed_;
  LoopReactions child_axes_, root_axes_;
  Load load_;                            // without closures
  std::vector<Wrench> tree_reactions_;   // by joint
  std::vector<ClosureWrench> closures_;  // by closure
  std::vector<double> effort_freedoms_;  // sums of squared changes over leastChange()
  bool all_exist_ = true;                // of the sample before
  std::optional<ForceRanges> ranges_;    // where they are asked for
  Motion rest_;
};

}  // namespace virtual_work_dynamics
