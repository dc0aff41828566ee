#include "generate/loop_model.h"

#include <limits>
#include <random>

#include "base/printable.h"
#include "loops/compared_length.h"
#include "loops/cut_tree.h"
#include "scene/payloads.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw SceneError("no code can be generated, as " + why);
}

// Refuses what has no straight line.
const Scene& generable(const Mechanism& mechanism, const Scene& scene, const Request& request) {
  for (const Closure& closure : scene.closures) {
    const ClosureTypeTraits& traits = traitsOf(closure.type);
    const std::string which = "closure " + inQuotes(closure.name);
    if (traits.touches()) refuse(which + " touches a plane");
    if (traits.meshes()) refuse(which + " is of teeth");
  }
  if (mechanism.orientations() > 0) {
    refuse("joints turn freely, whose orientations are given, in a scene with loops");
  }
  if (request.poses || request.twists) {
    refuse("poses or twists are asked for in a scene with loops");
  }
  return scene;
}

LoopScene resolved(const Mechanism& mechanism, const Scene& scene,
                   const ClosedLoopDynamics& dynamics) {
  LoopScene loops = resolveLoopScene(mechanism, scene);
  loops.actuated = dynamics.actuated();
  loops.residual = dynamics.residual();
  return loops;
}

LoopKinematics assembled(const Mechanism& mechanism, const Scene& scene,
                         const Eigen::VectorXd& assembly) {
  LoopKinematics kinematics(mechanism, scene);
  kinematics.setPosition(assembly);
  kinematics.adoptConstants();
  kinematics.setPosition(assembly);
  return kinematics;
}

LoopReactions reactionsOf(const LoopModel& model, const std::vector<std::string>& names,
                          bool about_origin, Axes axes) {
  const MomentPoints points(model.mechanism, model.scene);
  return {model.mechanism,
          model.scene,
          model.loops,
          model.groups,
          names,
          about_origin ? nullptr : &points,
          axes};
}

Plan<double> treeOf(const Mechanism& mechanism, const Scene& scene, const Request& wanted) {
  const Scene tree = openTreeScene(scene, PointSprings(mechanism, scene));
  Request request = treeRequest(mechanism, wanted);
  request.efforts = true;
  return roundPlan<double>(compilePlan(LoadedMechanism(mechanism, tree).get(), tree, request));
}

// How far from the assembly a usual position is looked for, rad or over the length, and how often.
constexpr double kBeside = 0.3;
constexpr int kTries = 24;
// A condition that is that of a usual position.
constexpr double kUsual = 1e3;

// A position that has nothing in common with the assembly, which may be singular, or special, but
// that the loops are closed: the one of least condition of those beside it.
Eigen::VectorXd positionOf(LoopModel& model) {
  ClosedLoopDynamics::Workspace workspace = model.dynamics.makeWorkspace();
  const Eigen::VectorXd& assembly = model.dynamics.assembly();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> beside(-kBeside, kBeside);
  Eigen::VectorXd best = assembly;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries && least > kUsual; ++i) {
    Motion motion(assembly.size());
    for (int j = 0; j < assembly.size(); ++j) {
      const double way = beside(random) * scaleOf(model.mechanism.unitOf(j), model.length);
      motion.q[j] = assembly[j] + way * (kTries - i) / kTries;
    }
    if (!model.dynamics.complete(motion, workspace)) continue;
    model.dynamics.compute(motion, workspace);
    if (workspace.results().singular()) continue;
    const double condition = workspace.results().loops.determinacy.condition;
    if (condition < least) best = motion.q;
    least = std::min(least, condition);
  }
  return best;
}

// Of redundant conditions not all are independent where loops are closed; where they are open, by
// noise or by far, they are.
constexpr double kOpen[] = {1e-3, 0.1};

std::vector<Eigen::VectorXd> usualPositions(LoopModel& model) {
  std::vector<Eigen::VectorXd> positions{positionOf(model)};
  std::mt19937 random(2);
  for (const double open : kOpen) {
    std::uniform_real_distribution<double> by(-open, open);
    Eigen::VectorXd q = positions.front();
    for (int j = 0; j < q.size(); ++j) {
      q[j] += by(random) * scaleOf(model.mechanism.unitOf(j), model.length);
    }
    positions.push_back(q);
  }
  return positions;
}

}  // namespace

LoopModel::LoopModel(const Mechanism& of, const Scene& from, const Request& request)
    : mechanism(of),
      scene(generable(of, from, request)),
      dynamics(of, from, request),
      loops(resolved(of, from, dynamics)),
      couplings(resolveCouplings(of, from)),
      kinematics(assembled(of, from, dynamics.assembly())),
      groups(loopGroups(of, kinematics)),
      length(loops.length.value_or(comparedLength(of, couplings, groups, kinematics))),
      solvers(of, loops, groups, kinematics, length),
      child_axes(
          reactionsOf(*this, request.child_axes, request.child_axes_about_origin, Axes::kLink)),
      root_axes(reactionsOf(*this, request.root_axes, false, Axes::kRoot)),
      tree(treeOf(of, from, request)),
      usual(usualPositions(*this)) {}

std::vector<std::string> LoopModel::effortNames() const {
  std::vector<std::string> names = mechanism.coordinateNames();
  for (const std::string& name : dynamics.actuatedClosures()) names.push_back(name);
  for (const ResolvedCoupling& coupling : couplings) names.push_back(coupling.name);
  return names;
}

std::vector<std::string> LoopModel::undetermined() const {
  Request request = dynamics.request();
  request.determinacy = true;
  request.residuals = request.can_hold = request.intervals = false;
  const ClosedLoopDynamics judged(mechanism, scene, request);
  ClosedLoopDynamics::Workspace workspace = judged.makeWorkspace();
  Motion motion(judged.coordinates());
  motion.q = usual.front();
  judged.compute(motion, workspace);
  const LoopResults& loops_of = workspace.results().loops;
  std::vector<std::string> open;
  const std::vector<std::string> names = effortNames();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!loops_of.effort_determined[i]) open.push_back("effort of " + names[i]);
  }
  const auto add = [&](const std::vector<std::string>& reactions,
                       const std::vector<Determined>& determined, const char* axes) {
    static const char* const kComponents[] = {"fx", "fy", "fz", "tx", "ty", "tz"};
    for (std::size_t i = 0; i < reactions.size(); ++i) {
      std::string text;
      for (std::size_t j = 0; j < 6; ++j) {
        if (!determined[i][j]) text += std::string(text.empty() ? "" : " ") + kComponents[j];
      }
      if (!text.empty()) open.push_back(text + " of " + reactions[i] + " in " + axes + " axes");
    }
  };
  add(request.child_axes, loops_of.child_axes_determined, "child");
  add(request.root_axes, loops_of.root_axes_determined, "root");
  return open;
}

}  // namespace virtual_work_dynamics
