#include "virtual_work_dynamics/closed_loop_dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loops/assembly.h"
#include "loops/completion.h"
#include "loops/cut_tree.h"
#include "loops/forces.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "loops/point_springs.h"
#include "loops/reactions.h"
#include "loops/residuals.h"
#include "scene/input_checks.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Moving joints of loops when the policy weighs their reactions.
Request effortRequest(const Mechanism& mechanism, const LoopScene& loops,
                      const std::vector<LoopGroup>& groups) {
  Request request;
  if (loops.policy != RedundancyPolicy::kStiffness) return request;
  for (const LoopGroup& group : groups) {
    for (const LoopGroup::CrossedJoint& crossed : group.joints) {
      const Joint& joint = mechanism.joints()[static_cast<std::size_t>(crossed.joint)];
      if (crossed.moves) request.root_axes.push_back(joint.name);
    }
  }
  return request;
}

Request reactionRequest(const Request& wanted, const LoopReactions& child_axes,
                        const LoopReactions& root_axes) {
  Request request;
  request.efforts = false;
  request.child_axes = child_axes.treeNames();
  request.root_axes = root_axes.treeNames();
  request.poses = wanted.poses;
  request.twists = wanted.twists;
  return request;
}

bool allFinite(const std::vector<Wrench>& wrenches) {
  return std::all_of(wrenches.begin(), wrenches.end(), [](const Wrench& wrench) {
    return wrench.force.allFinite() && wrench.torque.allFinite();
  });
}
}  // namespace

struct ClosedLoopDynamics::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& wanted);

  void close(const Mechanism& mechanism, const Scene& scene);
  void push(const Motion& motion);
  void setFreeMotions();
  void solve();
  void react(const Motion& motion);
  void setFlags();
  void setDeterminacy();

  Request request;
  bool static_motion;
  std::size_t own_wrenches;  // of the scene
  LoopScene loops;
  LoopKinematics kinematics;
  PointSprings springs;
  Scene tree;
  std::vector<Wrench> tree_wrenches;  // of springs and closures
  std::vector<LoopGroup> groups;
  std::unique_ptr<LoopCompletion> completion;
  Eigen::VectorXd assembly;
  std::vector<LoopForces> forces;
  std::unique_ptr<LoopReactions> child_axes, root_axes;

  // Efforts of the tree without closures, then reactions with them.
  std::unique_ptr<InverseDynamics> first_pass, second_pass;
  std::unique_ptr<Workspace> first, second;
  std::vector<Wrench> tree_reactions;   // by joint
  std::vector<int> reaction_joints;     // of the first pass
  std::vector<ClosureWrench> closures;  // by closure

  Eigen::VectorXd effort;
  std::vector<std::string> actuated_closures;
  Eigen::VectorXd closure_positions, closure_velocities;  // of these
  std::vector<Pose> poses;
  std::vector<Twist> twists;
  Determinacy determinacy;
  std::vector<double> closure_conditions;
  std::vector<bool> effort_determined;
  std::vector<double> effort_freedoms;  // sums of squares, of the least
  std::unique_ptr<LoopResiduals> residuals;
  Motion rest;
};

ClosedLoopDynamics::Impl::Impl(const Mechanism& mechanism, const Scene& scene,
                               const Request& wanted)
    : request(wanted),
      static_motion(scene.static_motion),
      own_wrenches(scene.applied_wrenches.size()),
      loops(resolveLoopScene(mechanism, scene)),
      kinematics(mechanism, scene),
      springs(mechanism, scene),
      tree(closedTreeScene(scene, springs)),
      tree_wrenches(tree.applied_wrenches.size() - own_wrenches),
      groups(loopGroups(mechanism, kinematics)),
      tree_reactions(mechanism.joints().size()),
      closures(scene.closures.size()),
      closure_conditions(scene.closures.size()),
      rest(static_cast<Eigen::Index>(mechanism.coordinates().size())) {
  close(mechanism, scene);
  child_axes.reset(
      new LoopReactions(mechanism, scene, loops, forces, wanted.child_axes, Axes::kLink));
  root_axes.reset(
      new LoopReactions(mechanism, scene, loops, forces, wanted.root_axes, Axes::kRoot));
  first_pass.reset(new InverseDynamics(mechanism, openTreeScene(scene, springs),
                                       effortRequest(mechanism, loops, groups)));
  for (const std::string& name : first_pass->request().root_axes) {
    reaction_joints.push_back(mechanism.jointIndex(name));
  }
  second_pass.reset(
      new InverseDynamics(mechanism, tree, reactionRequest(wanted, *child_axes, *root_axes)));
  first.reset(new Workspace(first_pass->makeWorkspace()));
  second.reset(new Workspace(second_pass->makeWorkspace()));
  for (const std::size_t c : loops.actuated_closures) {
    actuated_closures.push_back(scene.closures[c].name);
  }
  closure_positions.setZero(static_cast<Eigen::Index>(actuated_closures.size()));
  closure_velocities = closure_positions;
  effort.setZero(loops.start.size() + static_cast<Eigen::Index>(actuated_closures.size()));
  effort_determined.resize(static_cast<std::size_t>(effort.size()));
  effort_freedoms.resize(effort_determined.size());
  if (wanted.poses) poses.resize(wanted.root_axes.size());
  if (wanted.twists) twists.resize(wanted.root_axes.size());
}

// The size of the loops is known for good once they are closed.
void ClosedLoopDynamics::Impl::close(const Mechanism& mechanism, const Scene& scene) {
  kinematics.setPosition(loops.start);
  const double start_length = loops.length.value_or(loopLength(groups, kinematics));
  completion.reset(
      new LoopCompletion(mechanism, kinematics, groups, loops.rank_tolerance, start_length));
  assembly = assemble(scene, loops, *completion, kinematics);
  const double length = loops.length.value_or(loopLength(groups, kinematics));
  completion.reset(new LoopCompletion(mechanism, kinematics, groups, loops.rank_tolerance, length));
  residuals.reset(new LoopResiduals(mechanism, scene.closures.size(), length));
  for (const LoopGroup& group : groups) {
    forces.emplace_back(mechanism, kinematics, loops, group, length);
  }
  requireHeld(mechanism, loops, assembly, *completion, kinematics, forces);
}

void ClosedLoopDynamics::Impl::push(const Motion& motion) {
  kinematics.setPosition(motion.q);
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const Eigen::Vector3d force = springs.force(i, kinematics);
    tree_wrenches[2 * i] = {force, Eigen::Vector3d::Zero()};
    tree_wrenches[2 * i + 1] = {-force, Eigen::Vector3d::Zero()};
    for (const std::size_t end : {2 * i, 2 * i + 1}) {
      first->setAppliedWrench(own_wrenches + end, tree_wrenches[end].force,
                              tree_wrenches[end].torque);
    }
  }
  first_pass->compute(motion, *first);
  for (std::size_t i = 0; i < reaction_joints.size(); ++i) {
    tree_reactions[static_cast<std::size_t>(reaction_joints[i])] = first->rootAxes()[i];
  }
}

void ClosedLoopDynamics::Impl::setFreeMotions() {
  for (std::size_t i = 0; i < actuated_closures.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    closure_positions[place] = kinematics.freePosition(loops.actuated_closures[i]);
    closure_velocities[place] = kinematics.freeVelocity(loops.actuated_closures[i]);
  }
}

void ClosedLoopDynamics::Impl::solve() {
  for (std::size_t i = 0; i < loops.actuated.size(); ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(i);
    effort[row] = loops.actuated[i] ? first->effort()[row] : 0;
  }
  for (LoopForces& group : forces) {
    group.setPosition();
    group.solve(first->effort(), tree_reactions);
    const LoopForces::State& solution = group.solution();
    for (const LoopUnknowns::Effort& actuator : group.efforts()) {
      effort[static_cast<Eigen::Index>(actuator.index)] =
          actuator.unit * solution.x[actuator.unknown];
    }
    for (std::size_t c = 0; c < solution.closures.size(); ++c) {
      closures[group.group().closures[c]] = solution.closures[c];
    }
  }
}

void ClosedLoopDynamics::Impl::react(const Motion& motion) {
  for (std::size_t c = 0; c < closures.size(); ++c) {
    const ClosureWrench& wrench = closures[c];
    const std::size_t child = 2 * springs.size() + 2 * c;
    const Eigen::Vector3d lever = kinematics.childOrigin(c) - kinematics.parentOrigin(c);
    tree_wrenches[child] = {wrench.force, wrench.moment};
    tree_wrenches[child + 1] = {-wrench.force, -(wrench.moment + lever.cross(wrench.force))};
  }
  for (std::size_t i = 0; i < tree_wrenches.size(); ++i) {
    second->setAppliedWrench(own_wrenches + i, tree_wrenches[i].force, tree_wrenches[i].torque);
  }
  second_pass->compute(motion, *second);
  child_axes->setValues(kinematics, second->childAxes(), closures);
  root_axes->setValues(kinematics, second->rootAxes(), closures);
  if (request.poses) root_axes->setPoses(kinematics, second->poses(), poses);
  if (request.twists) root_axes->setTwists(kinematics, second->twists(), twists);
}

void ClosedLoopDynamics::Impl::setFlags() {
  child_axes->reset();
  root_axes->reset();
  std::fill(effort_freedoms.begin(), effort_freedoms.end(), 0);
  for (std::size_t g = 0; g < forces.size(); ++g) {
    LoopForces& group = forces[g];
    for (Eigen::Index i = 0; i < group.directions(); ++i) {
      const LoopForces::State& change = group.direction(i);
      child_axes->addChange(kinematics, g, group, change);
      root_axes->addChange(kinematics, g, group, change);
      for (const std::size_t j : change.touched_efforts) {
        const LoopUnknowns::Effort& actuator = group.efforts()[j];
        const double open = change.x[actuator.unknown] / group.leastChange();
        effort_freedoms[actuator.index] += open * open;
      }
    }
  }
  child_axes->setFlags();
  root_axes->setFlags();
  for (std::size_t i = 0; i < effort_freedoms.size(); ++i) {
    effort_determined[i] = effort_freedoms[i] <= 1;
  }
}

void ClosedLoopDynamics::Impl::setDeterminacy() {
  // Coordinates in no loop are actuated: each is an unknown of its own.
  determinacy = {};
  determinacy.rank = static_cast<int>(loops.start.size());
  determinacy.gap = std::numeric_limits<double>::infinity();
  determinacy.condition = 1;
  for (const LoopForces& group : forces) {
    determinacy.rank += static_cast<int>(group.rank() - group.coordinates());
    determinacy.free_motions += static_cast<int>(group.coordinates() - group.rank());
    determinacy.redundancy += static_cast<int>(group.unknowns() - group.rank());
    determinacy.redundant_constraints += static_cast<int>(group.redundantConstraints());
    determinacy.gap = std::min(determinacy.gap, group.gap());
    determinacy.condition = std::max(determinacy.condition, group.condition());
    for (const std::size_t c : group.group().closures) closure_conditions[c] = group.condition();
  }
}

ClosedLoopDynamics::ClosedLoopDynamics(const Mechanism& mechanism, const Scene& scene,
                                       const Request& request)
    : impl_(new Impl(mechanism, scene, request)) {}

ClosedLoopDynamics::~ClosedLoopDynamics() = default;
ClosedLoopDynamics::ClosedLoopDynamics(ClosedLoopDynamics&&) noexcept = default;
ClosedLoopDynamics& ClosedLoopDynamics::operator=(ClosedLoopDynamics&&) noexcept = default;

Eigen::Index ClosedLoopDynamics::coordinates() const {
  return impl_->loops.start.size();
}

const Request& ClosedLoopDynamics::request() const {
  return impl_->request;
}

const Eigen::VectorXd& ClosedLoopDynamics::assembly() const {
  return impl_->assembly;
}

const std::vector<bool>& ClosedLoopDynamics::actuated() const {
  return impl_->loops.actuated;
}

const std::vector<std::string>& ClosedLoopDynamics::actuatedClosures() const {
  return impl_->actuated_closures;
}

const Eigen::VectorXd& ClosedLoopDynamics::actuatedClosurePositions() const {
  return impl_->closure_positions;
}

const Eigen::VectorXd& ClosedLoopDynamics::actuatedClosureVelocities() const {
  return impl_->closure_velocities;
}

bool ClosedLoopDynamics::complete(Motion& motion) {
  return complete(motion, impl_->loops.actuated);
}

bool ClosedLoopDynamics::completeFromCloseBy(Motion& motion) {
  requireLengths(motion, coordinates());
  return impl_->completion->complete(impl_->kinematics, motion, impl_->loops.actuated,
                                     LoopCompletion::kFromCloseBy);
}

bool ClosedLoopDynamics::complete(Motion& motion, const std::vector<bool>& given) {
  requireLengths(motion, coordinates());
  if (given.size() != impl_->loops.actuated.size()) {
    throw MotionError("motion: " + std::to_string(given.size()) +
                      " coordinates are given or not, the mechanism has " +
                      std::to_string(coordinates()));
  }
  return impl_->completion->complete(impl_->kinematics, motion, given);
}

void ClosedLoopDynamics::setAppliedWrench(std::size_t index, const Eigen::Vector3d& force,
                                          const Eigen::Vector3d& torque) {
  if (index >= impl_->own_wrenches) {
    throw SceneError("the scene has no applied wrench " + std::to_string(index));
  }
  impl_->first->setAppliedWrench(index, force, torque);
  impl_->second->setAppliedWrench(index, force, torque);
}

void ClosedLoopDynamics::compute(const Motion& motion) {
  requireLengths(motion, coordinates());
  impl_->push(motion);
  impl_->residuals->set(impl_->kinematics, impl_->static_motion ? impl_->rest : motion);
  impl_->setFreeMotions();
  impl_->solve();
  impl_->react(motion);
  impl_->setFlags();
  impl_->setDeterminacy();
}

const Eigen::VectorXd& ClosedLoopDynamics::effort() const {
  return impl_->effort;
}

const std::vector<Wrench>& ClosedLoopDynamics::childAxes() const {
  return impl_->child_axes->values();
}

const std::vector<Wrench>& ClosedLoopDynamics::rootAxes() const {
  return impl_->root_axes->values();
}

const std::vector<Pose>& ClosedLoopDynamics::poses() const {
  return impl_->poses;
}

const std::vector<Twist>& ClosedLoopDynamics::twists() const {
  return impl_->twists;
}

bool ClosedLoopDynamics::finite() const {
  return impl_->effort.allFinite() && allFinite(childAxes()) && allFinite(rootAxes()) &&
         impl_->second->finite();
}

const Determinacy& ClosedLoopDynamics::determinacy() const {
  return impl_->determinacy;
}

const std::vector<bool>& ClosedLoopDynamics::effortDetermined() const {
  return impl_->effort_determined;
}

const std::vector<Determined>& ClosedLoopDynamics::childAxesDetermined() const {
  return impl_->child_axes->determined();
}

const std::vector<Determined>& ClosedLoopDynamics::rootAxesDetermined() const {
  return impl_->root_axes->determined();
}

const std::vector<double>& ClosedLoopDynamics::closureConditions() const {
  return impl_->closure_conditions;
}

const Scene& ClosedLoopDynamics::tree() const {
  return impl_->tree;
}

const std::vector<Wrench>& ClosedLoopDynamics::treeWrenches() const {
  return impl_->tree_wrenches;
}

const std::vector<ClosureResidual>& ClosedLoopDynamics::residuals() const {
  return impl_->residuals->values();
}

const std::vector<ClosureResidual>& ClosedLoopDynamics::relativeResiduals() const {
  return impl_->residuals->relative();
}

}  // namespace virtual_work_dynamics
