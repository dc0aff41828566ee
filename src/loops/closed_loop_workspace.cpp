#include <algorithm>
#include <limits>

#include "loops/compiled_loops.h"

namespace virtual_work_dynamics {

static_assert(sizeof(Wrench) == kWrenchNumbers * sizeof(double), "plain numbers");

namespace {

// Stands for a change of an effort that mechanics leaves open altogether; more than 1 is open.
constexpr double kOpenEffort = 2;

}  // namespace

ClosedLoopDynamics::Workspace::Impl::Impl(const ClosedLoopDynamics::Impl& compiled)
    : plan(compiled),
      solvers(plan.mechanism, plan.loops, plan.groups, plan.kinematics, plan.length),
      kernel_(&loopKernelFor(chosenInstructionSet()).one),
      tree_(plan.tree_pass->makeWorkspace()),
      child_axes_(*plan.child_axes),
      root_axes_(*plan.root_axes),
      tree_reactions_(plan.mechanism.joints().size()),
      closures_(plan.closures),
      rest_(plan.assembly.size()) {
  if (plan.weighed_pass) weighed_ = plan.weighed_pass->makeWorkspace();
  load_.wrenches.resize(plan.own_wrenches + 2 * plan.springs.size());
  const auto more_efforts =
      static_cast<Eigen::Index>(plan.actuated_closures.size() + plan.couplings.size());
  results.effort.setZero(plan.assembly.size() + more_efforts);
  results.child_axes.resize(child_axes_.size());
  results.root_axes.resize(root_axes_.size());
  if (plan.request.poses) results.poses.resize(root_axes_.size());
  if (plan.request.twists) results.twists.resize(root_axes_.size());
  LoopResults& loops = results.loops;
  effort_freedoms_.resize(static_cast<std::size_t>(results.effort.size()));
  determined.effort.assign(effort_freedoms_.size(), true);
  determined.child_axes.assign(child_axes_.size(), kAllComponents);
  determined.root_axes.assign(root_axes_.size(), kAllComponents);
  if (plan.request.determinacy) publishFlags();
  child_axes_ranks.resize(child_axes_.size());
  root_axes_ranks.resize(root_axes_.size());
  loops.effort_exists = determined.effort;
  loops.child_axes_exist = determined.child_axes;
  loops.root_axes_exist = determined.root_axes;
  loops.holds.assign(plan.holds.names().size(), Hold::kHolds);
  loops.springs_directed.assign(plan.springs.size(), true);
  const std::size_t sets = plan.closures + plan.couplings.size();
  loops.closure_conditions.assign(sets, 1);
  if (plan.request.residuals) {
    loops.residuals.resize(sets);
    loops.relative_residuals.resize(sets);
  }
  loops.actuated_positions.setZero(more_efforts);
  loops.actuated_velocities.setZero(more_efforts);
  if (!plan.couplings.empty()) loops.tree_effort.setZero(plan.assembly.size());
  loops.tree_wrenches.resize(plan.tree.applied_wrenches.size());
  if (plan.request.can_hold || plan.request.intervals) {
    ranges_.emplace(plan.request, plan.closure_names, plan.couplings.size(), plan.holds,
                    solvers.kinematics, solvers.forces, results);
  }
}

void ClosedLoopDynamics::Workspace::Impl::compute(const Motion& motion, const Load& load) {
  solvers.kinematics.setOrientations(motion.orientations);
  solvers.kinematics.setPosition(motion.q);
  move(plan.static_motion ? rest_ : motion);
  pushed_ = &tree_;
  push(motion, load);
  for (LoopForces& group : solvers.forces) {
    group.setPosition();
    group.solve(tree_.effort(), tree_reactions_);
  }
  report();
}

// Finds of the motion what is asked for.
void ClosedLoopDynamics::Workspace::Impl::move(const Motion& motion) {
  if (plan.request.residuals) {
    solvers.residuals.find(solvers.kinematics, motion, results.loops.residuals,
                           results.loops.relative_residuals);
    return;
  }
  if (plan.moves) solvers.kinematics.setVelocity(motion.qd);
  if (!plan.couplings.empty()) solvers.kinematics.setRates(motion.qd);
}

void ClosedLoopDynamics::Workspace::Impl::finish(const Load& load,
                                                 const virtual_work_dynamics::Workspace& tree) {
  std::copy(load.wrenches.begin(), load.wrenches.end(), load_.wrenches.begin());
  pushed_ = &tree;
  report();
}

// Makes results of solutions (3.1).
void ClosedLoopDynamics::Workspace::Impl::report() {
  setActuatedClosures();
  collect();
  react();
  setDeterminacy();
  if (plan.request.determinacy || plan.request.intervals || results.singular()) setDetermined();
  setExistence();
  plan.holds.judge(solvers.forces, results.loops.holds);
  if (ranges_) {
    ranges_->find(solvers.kinematics, solvers.forces, child_axes_, root_axes_,
                  {determined.effort, determined.child_axes, determined.root_axes}, results);
  }
  leaveOutSprings();
  if (plan.request.intervals && !all_exist_) ForceRanges::leaveOut(results);
  if (plan.request.determinacy) publishFlags();
}

void ClosedLoopDynamics::Workspace::Impl::publishFlags() {
  results.loops.effort_determined = determined.effort;
  results.loops.child_axes_determined = determined.child_axes;
  results.loops.root_axes_determined = determined.root_axes;
}

// Computes efforts and reactions of the open tree, which closures and actuators have to balance, at
// the position and motion of the kinematics.
void ClosedLoopDynamics::Workspace::Impl::push(const Motion& motion, const Load& load) {
  std::copy(load.wrenches.begin(), load.wrenches.end(), load_.wrenches.begin());
  for (std::size_t i = 0; i < plan.springs.size(); ++i) {
    const Eigen::Vector3d force = plan.springs.force(i, solvers.kinematics);
    results.loops.springs_directed[i] = plan.springs.directed(i, solvers.kinematics);
    const std::size_t end = plan.own_wrenches + 2 * i;
    load_.wrenches[end] = {force, Eigen::Vector3d::Zero()};
    load_.wrenches[end + 1] = {-force, Eigen::Vector3d::Zero()};
  }
  plan.tree_pass->compute(motion, load_, tree_);
  if (!weighed_) return;
  plan.weighed_pass->compute(motion, load_, *weighed_);
  for (std::size_t i = 0; i < plan.weighed_joints.size(); ++i) {
    tree_reactions_[static_cast<std::size_t>(plan.weighed_joints[i])] = weighed_->rootAxes()[i];
  }
}

void ClosedLoopDynamics::Workspace::Impl::setActuatedClosures() {
  for (std::size_t i = 0; i < plan.actuated_closures.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const std::size_t closure = plan.loops.actuated_closures[i];
    results.loops.actuated_positions[place] = solvers.kinematics.freePosition(closure);
    results.loops.actuated_velocities[place] = solvers.kinematics.freeVelocity(closure);
  }
}

// Efforts and closures' wrenches, which satisfy S^T tau + A^T lambda = tau_tree.
void ClosedLoopDynamics::Workspace::Impl::collect() {
  for (const int row : plan.open_efforts) results.effort[row] = pushed_->effort()[row];
  for (const LoopForces& group : solvers.forces) {
    const LoopForces::State& solution = group.solution();
    for (const LoopUnknowns::Effort& actuator : group.efforts()) {
      results.effort[static_cast<Eigen::Index>(actuator.index)] =
          actuator.unit * solution.x[actuator.unknown];
    }
    for (std::size_t c = 0; c < solution.closures.size(); ++c) {
      closures_[group.group().closures[c]] = solution.closures[c];
    }
    for (std::size_t local = solution.closures.size(); local < group.group().sets.size(); ++local) {
      results.effort[static_cast<Eigen::Index>(effortOf(group, local))] =
          group.unitsOf(local)[0] * solution.x[group.firstUnknownOf(local)];
    }
  }
  if (!plan.couplings.empty()) setCouplings();
}

std::size_t ClosedLoopDynamics::Workspace::Impl::effortOf(const LoopForces& group,
                                                          std::size_t local) const {
  const std::size_t coupling = group.group().sets[local] - plan.closures;
  return plan.loops.actuated.size() + plan.actuated_closures.size() + coupling;
}

// What couplings exert on coordinates, the column of A^T times the multiplier (3.1), and their
// sums.
void ClosedLoopDynamics::Workspace::Impl::setCouplings() {
  LoopResults& loops = results.loops;
  loops.tree_effort = results.effort.head(plan.assembly.size());
  const Eigen::Index first =
      loops.actuated_positions.size() - static_cast<Eigen::Index>(plan.couplings.size());
  for (std::size_t i = 0; i < plan.couplings.size(); ++i) {
    const Eigen::Index place = first + static_cast<Eigen::Index>(i);
    const double effort = results.effort[plan.assembly.size() + place];
    double sum = plan.couplings[i].mimicked;
    for (const ResolvedCoupling::Term& term : plan.couplings[i].terms) {
      sum += term.factor * solvers.kinematics.position()[term.coordinate];
      loops.tree_effort[term.coordinate] += term.factor * effort;
    }
    loops.actuated_positions[place] = sum;
    loops.actuated_velocities[place] =
        solvers.kinematics.rates()[solvers.kinematics.firstOf(plan.closures + i)];
  }
}

// Adds the closures' wrenches, applied to both of their links, to the reactions of the open tree:
// (3.8) is linear in the loads, and they change the joints between these links only.
void ClosedLoopDynamics::Workspace::Impl::react() {
  const LoopKinematics& kinematics = solvers.kinematics;
  std::vector<Wrench>& load = results.loops.tree_wrenches;
  std::copy(load_.wrenches.begin(), load_.wrenches.end(), load.begin());
  if (!closures_.empty()) {
    kernel_->closureLoads(static_cast<int>(closures_.size()), kinematics.frameNumbers(),
                          closures_.front().force.data(), load[load_.wrenches.size()].force.data());
  }
  for (const std::size_t c : kinematics.touching()) {  // loads act at points of the links
    kernel_->referToChild(kinematics.closure(c).shape(), kinematics.links().numbers(),
                          kinematics.frames(c).R_P.data(),
                          load[load_.wrenches.size() + 2 * c].force.data());
  }
  if (!plan.reacts) return;
  addClosures(child_axes_, pushed_->childAxes(), results.child_axes);
  addClosures(root_axes_, pushed_->rootAxes(), results.root_axes);
  if (plan.request.poses) root_axes_.setPoses(kinematics, pushed_->poses(), results.poses);
  if (plan.request.twists) root_axes_.setTwists(kinematics, pushed_->twists(), results.twists);
}

void ClosedLoopDynamics::Workspace::Impl::addClosures(const LoopReactions& reactions,
                                                      const std::vector<Wrench>& tree,
                                                      std::vector<Wrench>& values) const {
  if (values.empty()) return;
  const LoopKinematics& kinematics = solvers.kinematics;
  kernel_->reactions(
      reactions.view(),
      {kinematics.links().numbers(), kinematics.frameNumbers(),
       closures_.empty() ? nullptr : closures_.front().force.data(),
       tree.empty() ? nullptr : tree.front().force.data(), 1, values.front().force.data()});
}

void ClosedLoopDynamics::Workspace::Impl::setDetermined() {
  const LoopKinematics& kinematics = solvers.kinematics;
  child_axes_.reset();
  root_axes_.reset();
  std::fill(effort_freedoms_.begin(), effort_freedoms_.end(), 0);
  for (std::size_t g = 0; g < solvers.forces.size(); ++g) {
    LoopForces& group = solvers.forces[g];
    for (Eigen::Index i = 0; i < group.directions(); ++i) {
      const LoopForces::State& change = group.direction(i);
      child_axes_.addChange(kinematics, g, group, change);
      root_axes_.addChange(kinematics, g, group, change);
      for (const std::size_t j : change.touched_efforts) {
        const LoopUnknowns::Effort& actuator = group.efforts()[j];
        const double open = change.x[actuator.unknown] / group.leastChange();
        effort_freedoms_[actuator.index] += open * open;
      }
      for (const std::size_t local : change.touched_others) {
        const double open = change.x[group.firstUnknownOf(local)] / group.leastChange();
        effort_freedoms_[effortOf(group, local)] += open * open;
      }
    }
    if (group.bears()) continue;
    child_axes_.addUnborne(kinematics, g, group);
    root_axes_.addUnborne(kinematics, g, group);
    const std::vector<int>& coordinates = group.group().coordinates;
    for (std::size_t local = 0; local < coordinates.size(); ++local) {
      if (!group.isFree(static_cast<Eigen::Index>(local))) continue;
      effort_freedoms_[static_cast<std::size_t>(coordinates[local])] = kOpenEffort;
    }
  }
  child_axes_.setFlags(determined.child_axes);
  root_axes_.setFlags(determined.root_axes);
  for (std::size_t i = 0; i < effort_freedoms_.size(); ++i) {
    determined.effort[i] = effort_freedoms_[i] <= 1;
  }
}

void ClosedLoopDynamics::Workspace::Impl::setDeterminacy() {
  // Coordinates in no loop are actuated: each is an unknown of its own.
  LoopResults& loops = results.loops;
  Determinacy& determinacy = loops.determinacy;
  determinacy = {};
  determinacy.rank = static_cast<int>(plan.assembly.size());
  determinacy.gap = std::numeric_limits<double>::infinity();
  determinacy.condition = 1;
  for (const LoopForces& group : solvers.forces) {
    const Eigen::Index rank = group.rank();
    const double condition = group.condition();
    determinacy.rank += static_cast<int>(rank - group.coordinates());
    determinacy.free_motions += static_cast<int>(group.coordinates() - rank);
    determinacy.redundancy += static_cast<int>(group.unknowns() - rank);
    determinacy.redundant_constraints += static_cast<int>(group.redundantConstraints());
    determinacy.gap = std::min(determinacy.gap, group.gap());
    determinacy.condition = std::max(determinacy.condition, condition);
    for (const std::size_t s : group.group().sets) loops.closure_conditions[s] = condition;
  }
}

void ClosedLoopDynamics::Workspace::Impl::setRanks() {
  child_axes_.resetSpans();
  root_axes_.resetSpans();
  for (std::size_t g = 0; g < solvers.forces.size(); ++g) {
    LoopForces& group = solvers.forces[g];
    for (Eigen::Index i = 0; i < group.directions(); ++i) {
      const LoopForces::State& change = group.direction(i);
      child_axes_.addSpan(solvers.kinematics, g, group, change);
      root_axes_.addSpan(solvers.kinematics, g, group, change);
    }
    if (group.bears()) continue;
    child_axes_.addUnborneSpan(solvers.kinematics, g, group);
    root_axes_.addUnborneSpan(solvers.kinematics, g, group);
  }
  child_axes_.getRanks(child_axes_ranks);
  root_axes_.getRanks(root_axes_ranks);
}

// The one rule: in a singular position a component of a reaction has a value when it is determined
// there; when the position leaves no more of the wrench open than regular positions do; and when it
// is one of as many components that regular positions leave open as there are dimensions, as what
// the position opens then lies in the others. What is not determined in regular positions has the
// value that the scene's policy chooses. An effort of loops that are singular must be determined;
// so must that of a passive joint, zero, which is not what a load demands that nothing bears.
void ClosedLoopDynamics::Workspace::Impl::setExistence() {
  LoopResults& loops = results.loops;
  if (!all_exist_) {
    std::fill(loops.effort_exists.begin(), loops.effort_exists.end(), true);
    std::fill(loops.child_axes_exist.begin(), loops.child_axes_exist.end(), kAllComponents);
    std::fill(loops.root_axes_exist.begin(), loops.root_axes_exist.end(), kAllComponents);
  }
  all_exist_ = !results.singular() && !results.undirected();
  if (!results.singular()) return;
  setRanks();
  using UsuallyOpen = ClosedLoopDynamics::Impl::UsuallyOpen;
  const auto set = [](const std::vector<UsuallyOpen>& usual, const std::vector<int>& ranks,
                      const std::vector<Determined>& now, std::vector<Determined>& exist) {
    for (std::size_t i = 0; i < usual.size(); ++i) {
      if (ranks[i] <= usual[i].dimensions) continue;
      const bool separate = usual[i].components == usual[i].dimensions;
      for (std::size_t j = 0; j < now[i].size(); ++j) {
        exist[i][j] = now[i][j] || (separate && !usual[i].determined[j]);
      }
    }
  };
  set(plan.child_axes_usual, child_axes_ranks, determined.child_axes, loops.child_axes_exist);
  set(plan.root_axes_usual, root_axes_ranks, determined.root_axes, loops.root_axes_exist);
  for (const LoopForces& group : solvers.forces) {
    if (group.rank() == group.coordinates()) continue;
    for (const LoopUnknowns::Effort& actuator : group.efforts()) {
      loops.effort_exists[actuator.index] = determined.effort[actuator.index];
    }
    for (const int i : group.group().coordinates) {
      const auto coordinate = static_cast<std::size_t>(i);
      loops.effort_exists[coordinate] = determined.effort[coordinate];
    }
    const LoopGroup& of = group.group();
    for (std::size_t local = of.closures.size(); local < of.sets.size(); ++local) {
      const std::size_t coupling = effortOf(group, local);
      loops.effort_exists[coupling] = determined.effort[coupling];
    }
  }
}

// A force without a direction leaves everything without a value that it reaches.
void ClosedLoopDynamics::Workspace::Impl::leaveOutSprings() {
  if (plan.reach.empty() || !results.undirected()) return;
  LoopResults& loops = results.loops;
  constexpr Determined kNone{};
  for (std::size_t i = 0; i < plan.reach.size(); ++i) {
    if (loops.springs_directed[i]) continue;
    const SpringReach& reach = plan.reach[i];
    for (const std::size_t j : reach.efforts) {
      determined.effort[j] = loops.effort_exists[j] = false;
    }
    for (const std::size_t j : reach.child_axes) {
      determined.child_axes[j] = loops.child_axes_exist[j] = kNone;
    }
    for (const std::size_t j : reach.root_axes) {
      determined.root_axes[j] = loops.root_axes_exist[j] = kNone;
    }
    for (const std::size_t j : reach.holds) loops.holds[j] = Hold::kNotDecidable;
  }
}

}  // namespace virtual_work_dynamics
