#include "virtual_work_dynamics/closed_loop_dynamics.h"

#include <algorithm>
#include <utility>

#include "loops/assembly.h"
#include "loops/compared_length.h"
#include "loops/compiled_loops.h"
#include "loops/cut_tree.h"
#include "loops/given_loops.h"
#include "scene/input_checks.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

Request openTreeRequest(const Mechanism& mechanism, const Request& wanted) {
  Request request = treeRequest(mechanism, wanted);
  request.efforts = true;
  request.poses = wanted.poses;
  request.twists = wanted.twists;
  return request;
}

// Requests the moving joints of loops.
Request weighedRequest(const Mechanism& mechanism, const std::vector<LoopGroup>& groups) {
  Request request;
  request.efforts = false;
  for (const LoopGroup& group : groups) {
    for (const LoopGroup::CrossedJoint& crossed : group.joints) {
      if (crossed.moves) request.root_axes.push_back(mechanism.reactionName(crossed.joint));
    }
  }
  return request;
}

}  // namespace

LoopSolvers::LoopSolvers(const Mechanism& mechanism, const LoopScene& loops,
                         const std::vector<LoopGroup>& groups, const LoopKinematics& start,
                         double length)
    : kinematics(start),
      completion(mechanism, kinematics, groups, loops.rank_tolerance, length),
      // What couplings alone leave open is compared with a metre: fine screws turn far for little.
      residuals(mechanism, kinematics, start.closures() > 0 ? length : loops.length.value_or(1)) {
  forces.reserve(groups.size());
  for (const LoopGroup& group : groups) {
    forces.emplace_back(mechanism, kinematics, loops, group, length);
  }
}

ClosedLoopDynamics::Impl::Impl(const Mechanism& of, const Scene& scene, const Request& wanted)
    : request(wanted),
      mechanism(of),
      static_motion(scene.static_motion),
      loops(resolveLoopScene(mechanism, scene)),
      couplings(resolveCouplings(mechanism, scene)),
      springs(mechanism, scene),
      bare_tree(withoutLoops(scene)),
      tree(closedTreeScene(scene, springs)),
      own_wrenches(scene.applied_wrenches.size()),
      own_load(scene),
      reacts(!wanted.child_axes.empty() || !wanted.root_axes.empty()),
      moves(wanted.twists || springs.damped() || !loops.actuated_closures.empty()),
      closures(scene.closures.size()),
      kinematics(mechanism, scene),
      groups(loopGroups(mechanism, kinematics)),
      holds(scene, kinematics, groups) {
  for (const Closure& closure : scene.closures) closure_names.push_back(closure.name);
  for (const std::size_t c : loops.actuated_closures) {
    actuated_closures.push_back(scene.closures[c].name);
  }
  for (std::size_t i = 0; i < springs.size(); ++i) {
    reach.emplace_back(mechanism, scene, loops, groups, springs, i, wanted, holds.names());
  }
  close(scene);
  std::vector<bool> in_loop(loops.actuated.size(), false);
  for (const LoopGroup& group : groups) {
    for (const int i : group.coordinates) in_loop[static_cast<std::size_t>(i)] = true;
  }
  for (std::size_t i = 0; i < in_loop.size(); ++i) {
    if (loops.actuated[i] && !in_loop[i]) open_efforts.push_back(static_cast<int>(i));
  }
  const MomentPoints points(mechanism, scene);
  child_axes = std::make_unique<LoopReactions>(mechanism, scene, loops, groups, wanted.child_axes,
                                               wanted.child_axes_about_origin ? nullptr : &points,
                                               Axes::kLink);
  root_axes = std::make_unique<LoopReactions>(mechanism, scene, loops, groups, wanted.root_axes,
                                              &points, Axes::kRoot);
  const Scene open_tree = openTreeScene(scene, springs);
  tree_pass =
      std::make_unique<InverseDynamics>(mechanism, open_tree, openTreeRequest(mechanism, wanted));
  if (loops.policy == RedundancyPolicy::kStiffness) {
    weighed_pass = std::make_unique<InverseDynamics>(mechanism, wholeReactionsScene(open_tree),
                                                     weighedRequest(mechanism, groups));
    for (const std::string& name : weighed_pass->request().root_axes) {
      weighed_joints.push_back(mechanism.reactionIndex(name));
    }
  }
  setUsual();
}

// The final size of the loops is known once they are closed.
void ClosedLoopDynamics::Impl::close(const Scene& scene) {
  kinematics.setPosition(loops.start);
  const double start_length =
      loops.length.value_or(comparedLength(mechanism, couplings, groups, kinematics));
  LoopCompletion completion(mechanism, kinematics, groups, loops.rank_tolerance, start_length);
  assembly = assemble(scene, loops, completion, kinematics);
  length = loops.length.value_or(comparedLength(mechanism, couplings, groups, kinematics));
  if (scene.free_motion) chooseResidual(scene);
  LoopSolvers solvers(mechanism, loops, groups, kinematics, length);
  way = kinematics.largestBent(assembly - loops.start, solvers.completion.scales());
  requireHeld(mechanism, loops, assembly, solvers.completion, solvers.kinematics, solvers.forces);
  requireSprings(solvers);
}

// Counts as actuated, one after the other, the coordinates of motions that nothing holds: their
// efforts are then what nothing delivers.
void ClosedLoopDynamics::Impl::chooseResidual(const Scene& scene) {
  for (;;) {
    LoopSolvers solvers(mechanism, loops, groups, kinematics, length);
    const int freest = freestCoordinate(mechanism, loops, assembly, solvers.completion,
                                        solvers.kinematics, solvers.forces);
    if (freest < 0) break;
    loops.actuated[static_cast<std::size_t>(freest)] = true;
    loops.residual[static_cast<std::size_t>(freest)] = true;
  }
  if (!scene.given) loops.given.coordinates = loops.actuated;
}

// Refuses springs that have no length in the assembly nor beside it: their ends always coincide.
void ClosedLoopDynamics::Impl::requireSprings(LoopSolvers& solvers) const {
  const auto without = [&](std::size_t i, const LoopKinematics& at) {
    return springs.length(i, at) <= kCoincide * length;
  };
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (!without(i, kinematics)) continue;
    const Eigen::VectorXd beside =
        positionBeside(assembly, mechanism, solvers.completion, solvers.kinematics);
    solvers.kinematics.setPosition(beside);
    if (!without(i, solvers.kinematics)) continue;
    throw SceneError("springs: '" + springs.name(i) +
                     "': its ends coincide in every position, so that it has no direction");
  }
}

std::vector<ClosedLoopDynamics::Impl::UsuallyOpen> ClosedLoopDynamics::Impl::usuallyOpen(
    const std::vector<Determined>& determined, const std::vector<int>& ranks) {
  std::vector<UsuallyOpen> usual;
  for (std::size_t i = 0; i < determined.size(); ++i) {
    const auto open = std::count(determined[i].begin(), determined[i].end(), false);
    usual.push_back({determined[i], static_cast<int>(open), ranks[i]});
  }
  return usual;
}

// Finds the flags of a regular position once: what exists in a singular one must not depend on the
// positions met before.
void ClosedLoopDynamics::Impl::setUsual() {
  Workspace::Impl workspace(*this);
  LoopSolvers& solvers = workspace.solvers;
  Motion motion(assembly.size());
  motion.q = positionBeside(assembly, mechanism, solvers.completion, solvers.kinematics);
  workspace.compute(motion, own_load);
  if (workspace.results.singular()) {
    motion.q = assembly;
    workspace.compute(motion, own_load);
  }
  workspace.setDetermined();
  workspace.setRanks();
  child_axes_usual = usuallyOpen(workspace.determined.child_axes, workspace.child_axes_ranks);
  root_axes_usual = usuallyOpen(workspace.determined.root_axes, workspace.root_axes_ranks);
}

ClosedLoopDynamics::ClosedLoopDynamics(const Mechanism& mechanism, const Scene& scene,
                                       const Request& request)
    : impl_(new Impl(mechanism, scene, request)) {}

ClosedLoopDynamics::~ClosedLoopDynamics() = default;
ClosedLoopDynamics::ClosedLoopDynamics(ClosedLoopDynamics&&) noexcept = default;
ClosedLoopDynamics& ClosedLoopDynamics::operator=(ClosedLoopDynamics&&) noexcept = default;

std::size_t ClosedLoopDynamics::orientations() const {
  return impl_->mechanism.orientations();
}

Eigen::Index ClosedLoopDynamics::coordinates() const {
  return impl_->assembly.size();
}

const Request& ClosedLoopDynamics::request() const {
  return impl_->request;
}

const Eigen::VectorXd& ClosedLoopDynamics::assembly() const {
  return impl_->assembly;
}

double ClosedLoopDynamics::assemblyWay() const {
  return impl_->way;
}

std::vector<std::string> ClosedLoopDynamics::assemblyDoubts() const {
  return farFromStart(impl_->mechanism, impl_->kinematics, impl_->loops.start, impl_->assembly,
                      impl_->length);
}

const std::vector<bool>& ClosedLoopDynamics::actuated() const {
  return impl_->loops.actuated;
}

const std::vector<bool>& ClosedLoopDynamics::residual() const {
  return impl_->loops.residual;
}

const Given& ClosedLoopDynamics::given() const {
  return impl_->loops.given;
}

std::unique_ptr<GivenLoops> ClosedLoopDynamics::givenLoops(const Given& given) const {
  return std::make_unique<GivenLoops>(impl_->mechanism, impl_->kinematics, impl_->closure_names,
                                      given, impl_->loops.rank_tolerance, impl_->length);
}

ClosedLoopDynamics::GivenFinding ClosedLoopDynamics::judge(const Given& given) const {
  requireGiven(given.coordinates);
  Workspace workspace = makeWorkspace();
  LoopSolvers& solvers = workspace.solversOf(*impl_);
  const Eigen::VectorXd regular =
      positionBeside(impl_->assembly, impl_->mechanism, solvers.completion, solvers.kinematics);
  const std::vector<std::string>& names = impl_->mechanism.coordinateNames();
  const std::unique_ptr<GivenLoops> loops = givenLoops(given);
  GivenFinding finding;
  finding.freedom = loops->freedom(regular, given.coordinates);
  if (finding.freedom > 0) {
    for (const std::size_t i : loops->undetermined(regular)) {
      finding.undetermined.push_back(names[i]);
    }
    return finding;
  }
  const auto followsWhenLeft = [&](const Given& rest) {
    return givenLoops(rest)->freedom(regular, rest.coordinates) == 0;
  };
  Given rest = given;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!given.coordinates[i]) continue;
    rest.coordinates[i] = false;
    if (loops->freedom(regular, rest.coordinates) == 0) finding.follow.push_back(names[i]);
    rest.coordinates[i] = true;
  }
  for (std::size_t i = 0; i < given.closures.size(); ++i) {
    rest.closures.erase(rest.closures.begin() + static_cast<std::ptrdiff_t>(i));
    if (followsWhenLeft(rest)) finding.follow.push_back(impl_->closure_names[given.closures[i]]);
    rest.closures = given.closures;
  }
  for (std::size_t i = 0; i < given.links.size(); ++i) {
    rest.links.erase(rest.links.begin() + static_cast<std::ptrdiff_t>(i));
    if (followsWhenLeft(rest)) {
      finding.follow.push_back("pose." + impl_->mechanism.link(given.links[i]).name);
    }
    rest.links = given.links;
  }
  if (!finding.follow.empty()) return finding;
  // Positions that only just suffice may come with rates that conditions on rates alone tie.
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!given.coordinates[i]) continue;
    rest.coordinates[i] = false;
    if (loops->freedomOfRates(regular, rest.coordinates) == 0) finding.follow.push_back(names[i]);
    rest.coordinates[i] = true;
  }
  return finding;
}

const std::vector<std::string>& ClosedLoopDynamics::actuatedClosures() const {
  return impl_->actuated_closures;
}

const std::vector<std::string>& ClosedLoopDynamics::oneSided() const {
  return impl_->holds.names();
}

const Scene& ClosedLoopDynamics::tree() const {
  return impl_->tree;
}

PlanSummary ClosedLoopDynamics::summary() const {
  return InverseDynamics(impl_->mechanism, impl_->bare_tree,
                         treeRequest(impl_->mechanism, impl_->request))
      .summary();
}

ClosedLoopDynamics::Workspace ClosedLoopDynamics::makeWorkspace() const {
  return Workspace(*impl_);
}

bool ClosedLoopDynamics::complete(Motion& motion, Workspace& workspace) const {
  return complete(motion, impl_->loops.actuated, workspace);
}

bool ClosedLoopDynamics::completeFromCloseBy(Motion& motion, Workspace& workspace) const {
  return completeFromCloseBy(motion, impl_->loops.actuated, workspace);
}

bool ClosedLoopDynamics::completeFromCloseBy(Motion& motion, const std::vector<bool>& given,
                                             Workspace& workspace) const {
  LoopSolvers& solvers = workspace.solversOf(*impl_);
  requireLengths(motion, coordinates());
  requireGiven(given);
  requireOrientations(motion, impl_->mechanism.orientations());
  solvers.kinematics.setOrientations(motion.orientations);
  return solvers.completion.complete(solvers.kinematics, motion, given,
                                     LoopCompletion::kFromCloseBy);
}

bool ClosedLoopDynamics::complete(Motion& motion, const std::vector<bool>& given,
                                  Workspace& workspace) const {
  LoopSolvers& solvers = workspace.solversOf(*impl_);
  requireLengths(motion, coordinates());
  requireGiven(given);
  requireOrientations(motion, impl_->mechanism.orientations());
  solvers.kinematics.setOrientations(motion.orientations);
  return solvers.completion.complete(solvers.kinematics, motion, given);
}

void ClosedLoopDynamics::requireGiven(const std::vector<bool>& given) const {
  if (given.size() == impl_->loops.actuated.size()) return;
  throw MotionError("motion: 'given' has " + std::to_string(given.size()) +
                    " entries, the mechanism has " + std::to_string(coordinates()) +
                    " coordinates");
}

bool ClosedLoopDynamics::determine(const Eigen::VectorXd& q, const std::vector<bool>& given,
                                   Workspace& workspace) const {
  LoopSolvers& solvers = workspace.solversOf(*impl_);
  requireGiven(given);
  solvers.kinematics.setPosition(q);
  return solvers.completion.determine(solvers.kinematics, given);
}

void ClosedLoopDynamics::compute(const Motion& motion, Workspace& workspace) const {
  compute(motion, impl_->own_load, workspace);
}

void ClosedLoopDynamics::compute(const Motion& motion, const Load& load,
                                 Workspace& workspace) const {
  workspace.solversOf(*impl_);
  requireLengths(motion, coordinates());
  requireOrientations(motion, impl_->mechanism.orientations());
  requireLoad(load, impl_->own_wrenches);
  workspace.impl_->compute(motion, load);
}

ClosedLoopDynamics::Workspace::Workspace(const ClosedLoopDynamics::Impl& plan)
    : impl_(new Impl(plan)) {}

ClosedLoopDynamics::Workspace::~Workspace() = default;
ClosedLoopDynamics::Workspace::Workspace(Workspace&&) noexcept = default;
ClosedLoopDynamics::Workspace& ClosedLoopDynamics::Workspace::operator=(Workspace&&) noexcept =
    default;

const Results& ClosedLoopDynamics::Workspace::results() const {
  return impl_->results;
}

LoopSolvers& ClosedLoopDynamics::Workspace::solversOf(const ClosedLoopDynamics::Impl& plan) {
  if (&impl_->plan != &plan) {
    throw MotionError("the workspace belongs to another ClosedLoopDynamics");
  }
  return impl_->solvers;
}

}  // namespace virtual_work_dynamics
