#include "virtual_work_dynamics/dynamics.h"

#include <algorithm>

#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/compiled_dynamics.h"
#include "dynamics/given_joints.h"
#include "loops/compiled_loops.h"
#include "loops/cut_tree.h"
#include "loops/given_loops.h"
#include "scene/input_checks.h"
#include "scene/touch_rows.h"
#include "virtual_work_dynamics/drives.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Relative misfit below which the loops count as closed, so that the position is what hinders.
constexpr double kClosed = 1e-9;

// What motions give beside drives: of the coordinates that they gave without these, then, unless
// the scene says which, of the others, those that do not follow.
Given besideDrives(const ClosedLoopDynamics& loops, const std::vector<bool>& driven,
                   bool others_too) {
  const Given& usual = loops.given();
  Given given = usual;
  given.coordinates = driven;
  Eigen::Index freedom = loops.judge(given).freedom;
  for (const bool preferred : {true, false}) {
    if (!preferred && !others_too) break;
    for (std::size_t i = 0; i < driven.size() && freedom > 0; ++i) {
      if (given.coordinates[i] || usual.coordinates[i] != preferred) continue;
      given.coordinates[i] = true;
      const Eigen::Index left = loops.judge(given).freedom;
      if (left == freedom) given.coordinates[i] = false;
      freedom = left;
    }
  }
  return given;
}

// Refuses drives that say twice how something moves.
void requireFree(const Dynamics& dynamics, const Scene& scene) {
  const std::vector<std::string> follow = dynamics.judge(dynamics.given()).follow;
  std::string names;
  for (const DriveLaw& drive : scene.drives) {
    if (std::find(follow.begin(), follow.end(), drive.name) == follow.end()) continue;
    names += (names.empty() ? "" : ", ") + inQuotes(drive.name);
  }
  if (names.empty()) return;
  throw SceneError("drives: the motion of " + names +
                   " follows from what else drives and `given` say; leave one out");
}

Request everything(const Mechanism& mechanism, const Scene& scene) {
  Request request;
  request.child_axes = requestedReactions(mechanism, scene);
  request.root_axes = request.child_axes;
  request.can_hold = request.intervals = scene.contact_intervals;
  return request;
}

}  // namespace

Dynamics::Impl::Impl(const Mechanism& mechanism, const Scene& scene, const Request& request,
                     InstructionSet instruction_set)
    : tree(scene),
      tree_request(request),
      own_load(scene),
      effort_names(mechanism.coordinateNames()),
      residuals(effort_names.size(), false),
      actuated(mechanism.coordinates().size(), true),
      assembly(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(actuated.size()))) {
  given.coordinates = actuated;
  coupled.assign(actuated.size(), false);
  bends.assign(actuated.size(), true);
  if (!scene.drives.empty()) Drives(mechanism, scene);  // refuses bad ones
  if (!needsClosedLoops(scene)) {
    chain.emplace(mechanism, scene, request, instruction_set);
    return;
  }
  if (!isSupported(instruction_set)) {
    throw Error("this machine or build has no " + toString(instruction_set) + " instructions");
  }
  loops.emplace(mechanism, scene, request);
  tree = loops->tree();
  tree_request = virtual_work_dynamics::treeRequest(mechanism, request);
  actuated = loops->actuated();
  for (std::size_t i = 0; i < actuated.size(); ++i) {
    residuals[i] = loops->residual()[i];
    if (residuals[i]) effort_names[i] = kMotionResidual + effort_names[i];
  }
  given = loops->given();
  have_positions = hasPositions(scene);
  // The axes of actuated closures that have no drives would have to be given, too, and where there
  // are no positions to be found all of them.
  const bool axes_lack = loops->actuatedClosures().size() > given.closures.size();
  if (!scene.given && (axes_lack || !have_positions)) {
    given.coordinates.assign(actuated.size(), true);
  }
  if (!scene.drives.empty() && have_positions) {
    given = besideDrives(*loops, Drives(mechanism, scene).coordinates(), !scene.given);
  }
  assembly = loops->assembly();
  const std::vector<std::string>& closures = loops->actuatedClosures();
  effort_names.insert(effort_names.end(), closures.begin(), closures.end());
  for (const Coupling& coupling : scene.couplings) effort_names.push_back(coupling.name);
  residuals.resize(effort_names.size(), false);
  for (const Closure& closure : scene.closures) closure_names.push_back(closure.name);
  first_coupling = closure_names.size();
  for (const Coupling& coupling : scene.couplings) closure_names.push_back(coupling.name);
  const LoopKinematics& kinematics = loops->impl_->kinematics;
  for (std::size_t s = 0; s < kinematics.sets(); ++s) {
    if (!kinematics.set(s).isLinear()) continue;
    for (const int coordinate : kinematics.set(s).coordinates()) {
      coupled[static_cast<std::size_t>(coordinate)] = true;
      bends[static_cast<std::size_t>(coordinate)] = kinematics.bends(coordinate);
    }
  }
}

Dynamics::Dynamics(const Mechanism& mechanism, const Scene& scene, const Request& request,
                   InstructionSet instruction_set)
    : impl_(new Impl(mechanism, scene, request, instruction_set)) {
  if (!scene.drives.empty() && impl_->loops && impl_->have_positions) requireFree(*this, scene);
  if (!scene.given && given().closures.empty()) return;
  const auto problem = GivenJoints(mechanism, *this).problem(given());
  if (problem) throw GivenError(*problem);
}

Dynamics::Dynamics(const Mechanism& mechanism, const Scene& scene)
    : Dynamics(mechanism, scene, everything(mechanism, scene)) {}

Dynamics::~Dynamics() = default;
Dynamics::Dynamics(Dynamics&&) noexcept = default;
Dynamics& Dynamics::operator=(Dynamics&&) noexcept = default;

Eigen::Index Dynamics::coordinates() const {
  return impl_->assembly.size();
}

std::size_t Dynamics::orientations() const {
  return impl_->chain ? impl_->chain->orientations() : impl_->loops->orientations();
}

const Request& Dynamics::request() const {
  return impl_->chain ? impl_->chain->request() : impl_->loops->request();
}

const std::vector<std::string>& Dynamics::effortNames() const {
  return impl_->effort_names;
}

const std::vector<bool>& Dynamics::residuals() const {
  return impl_->residuals;
}

bool Dynamics::closed() const {
  return impl_->loops.has_value();
}

const std::vector<std::string>& Dynamics::closureNames() const {
  return impl_->closure_names;
}

const std::vector<std::string>& Dynamics::oneSided() const {
  static const std::vector<std::string> kNone;
  return impl_->loops ? impl_->loops->oneSided() : kNone;
}

std::string Dynamics::closureLabel(std::size_t i) const {
  return (i < impl_->first_coupling ? "closure " : "coupling ") + inQuotes(impl_->closure_names[i]);
}

std::size_t Dynamics::couplings() const {
  return impl_->closure_names.size() - impl_->first_coupling;
}

const std::vector<bool>& Dynamics::actuated() const {
  return impl_->actuated;
}

const Given& Dynamics::given() const {
  return impl_->given;
}

ClosedLoopDynamics::GivenFinding Dynamics::judge(const Given& given) const {
  return impl_->loops ? impl_->loops->judge(given) : ClosedLoopDynamics::GivenFinding();
}

std::unique_ptr<GivenLoops> Dynamics::givenLoops(const Given& given) const {
  return impl_->loops->givenLoops(given);
}

bool Dynamics::closuresDetermine() const {
  return !impl_->closure_names.empty() && impl_->loops->actuatedClosures().empty() &&
         impl_->have_positions;
}

const Eigen::VectorXd& Dynamics::assembly() const {
  return impl_->assembly;
}

double Dynamics::assemblyWay() const {
  return impl_->loops ? impl_->loops->assemblyWay() : 0;
}

std::vector<std::string> Dynamics::assemblyDoubts() const {
  return impl_->loops ? impl_->loops->assemblyDoubts() : std::vector<std::string>();
}

const Scene& Dynamics::tree() const {
  return impl_->tree;
}

const Request& Dynamics::treeRequest() const {
  return impl_->tree_request;
}

void Dynamics::getTreeLoad(const Results& results, Load& load) const {
  getTreeLoad(results, impl_->own_load, load);
}

void Dynamics::getTreeLoad(const Results& results, const Load& given, Load& load) const {
  load.wrenches = closed() ? results.loops.tree_wrenches : given.wrenches;
}

PlanSummary Dynamics::summary() const {
  return impl_->chain ? impl_->chain->summary() : impl_->loops->summary();
}

Dynamics::Workspace Dynamics::makeWorkspace() const {
  return Workspace(*impl_);
}

bool Dynamics::complete(Motion& motion, Workspace& workspace) const {
  Workspace::Impl& memory = workspace.memoryFor(*impl_);
  if (impl_->loops) return impl_->loops->complete(motion, *memory.loops);
  requireLengths(motion, coordinates());
  return true;
}

bool Dynamics::completeFromCloseBy(Motion& motion, Workspace& workspace) const {
  return completeFromCloseBy(motion, impl_->actuated, workspace);
}

bool Dynamics::completeFromCloseBy(Motion& motion, const std::vector<bool>& given,
                                   Workspace& workspace) const {
  Workspace::Impl& memory = workspace.memoryFor(*impl_);
  if (impl_->loops) return impl_->loops->completeFromCloseBy(motion, given, *memory.loops);
  requireLengths(motion, coordinates());
  return true;
}

std::string Dynamics::whyOpen(const Motion& motion, Workspace& workspace) const {
  return whyOpen(motion, impl_->actuated, workspace);
}

std::string Dynamics::whyOpen(const Motion& motion, const std::vector<bool>& given,
                              Workspace& workspace) const {
  ClosedLoopDynamics::Workspace& memory = *workspace.memoryFor(*impl_).loops;
  const ClosedLoopDynamics::Residuals found = impl_->loops->residualsOf(motion, memory);
  const auto worst = std::max_element(
      found.relative.begin(), found.relative.end(),
      [](const auto& one, const auto& other) { return one.position < other.position; });
  if (worst == found.relative.end() || worst->position <= kClosed) {
    if (impl_->loops->determine(motion.q, given, memory)) {
      return kContradiction;
    }
    return kSingularPosition;
  }
  const auto closure = static_cast<std::size_t>(worst - found.relative.begin());
  return "the loops cannot be closed: " + closureLabel(closure) + " stays open by " +
         numberText(found.plain[closure].position) + " m or rad";
}

void Dynamics::compute(const Motion& motion, Workspace& workspace) const {
  Workspace::Impl& memory = workspace.memoryFor(*impl_);
  if (impl_->chain) impl_->chain->compute(motion, *memory.chain);
  if (impl_->loops) impl_->loops->compute(motion, *memory.loops);
}

void Dynamics::compute(const Motion& motion, const Load& load, Workspace& workspace) const {
  Workspace::Impl& memory = workspace.memoryFor(*impl_);
  if (impl_->chain) impl_->chain->compute(motion, load, *memory.chain);
  if (impl_->loops) impl_->loops->compute(motion, load, *memory.loops);
}

Dynamics::Workspace::Workspace(const Dynamics::Impl& plan) : impl_(new Impl) {
  impl_->plan = &plan;
  if (plan.chain) impl_->chain.emplace(plan.chain->makeWorkspace());
  if (plan.loops) impl_->loops.emplace(plan.loops->makeWorkspace());
}

Dynamics::Workspace::Impl& Dynamics::Workspace::memoryFor(const Dynamics::Impl& plan) {
  if (impl_->plan != &plan) throw MotionError("the workspace belongs to another Dynamics");
  return *impl_;
}

Dynamics::Workspace::~Workspace() = default;
Dynamics::Workspace::Workspace(Workspace&&) noexcept = default;
Dynamics::Workspace& Dynamics::Workspace::operator=(Workspace&&) noexcept = default;

const Results& Dynamics::Workspace::results() const {
  return impl_->chain ? impl_->chain->results() : impl_->loops->results();
}

}  // namespace virtual_work_dynamics
