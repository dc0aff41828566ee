#include "dynamics/motion_start.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>

#include "dynamics/given_joints.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/passive_joints.h"

namespace virtual_work_dynamics {
namespace {

// A start counts as a sensible one when no joint is further from closed, rad or of the length.
constexpr double kSensible = 0.1;
// How much nearer to closed another start must be to be preferred to it.
constexpr double kClearly = 0.5;

std::vector<std::string> namesOf(const Mechanism& mechanism, const Scene& scene,
                                 const Given& given) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    const auto isIt = [&](const DriveLaw& drive) { return drive.name == name; };
    if (std::none_of(scene.drives.begin(), scene.drives.end(), isIt)) names.push_back(name);
  };
  for (std::size_t i = 0; i < given.coordinates.size(); ++i) {
    if (given.coordinates[i]) add(mechanism.coordinateNames()[i]);
  }
  for (const std::size_t c : given.closures) add(scene.closures[c].name);
  for (const int link : given.links) names.push_back("pose." + mechanism.link(link).name);
  return names;
}

// Puts the given positions in place of those that the scene has.
void placeGiven(const Mechanism& mechanism, const MotionStart& start, Scene& scene) {
  const std::vector<std::string>& names = mechanism.coordinateNames();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!start.given.coordinates[i]) continue;
    const auto isIt = [&](const NamedNumber& placed) { return placed.name == names[i]; };
    auto& assembly = scene.assembly;
    assembly.erase(std::remove_if(assembly.begin(), assembly.end(), isIt), assembly.end());
    assembly.push_back({names[i], start.motion.q[static_cast<Eigen::Index>(i)]});
  }
}

// What a start leads to.
struct Trial {
  std::exception_ptr open;  // why the loops cannot be closed from it; null: they can
  double way = 0;           // from there to closed
  bool leads = false;       // whether the motion's start is reached
};

Trial tried(const Mechanism& mechanism, const Scene& scene, const MotionStart& start) {
  Trial trial;
  try {
    const Dynamics dynamics(mechanism, scene, Request());
    trial.way = dynamics.assemblyWay();
    if (GivenJoints::givesAll(start.given)) {
      trial.leads = true;
      return trial;
    }
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    Motion motion(dynamics.coordinates());
    motion.q = start.motion.q;
    motion.orientations = start.motion.orientations;
    Motion driven(static_cast<Eigen::Index>(start.given.drivenNumbers()));
    driven.q = start.driven.q;
    trial.leads = PassiveJoints(mechanism, dynamics, start.given)
                      .complete(motion, driven, dynamics, workspace);
  } catch (const AssemblyError&) {
    trial.open = std::current_exception();
  }
  return trial;
}

bool prefersMotion(const Trial& of_scene, const Trial& of_motion) {
  if (of_motion.open || of_scene.open) return !of_motion.open;
  if (of_scene.leads != of_motion.leads) return of_motion.leads;
  return of_scene.way > kSensible && of_motion.way < kClearly * of_scene.way;
}

}  // namespace

Scene startedBy(const Mechanism& mechanism, const Scene& scene, const MotionStart& start) {
  Scene of_scene = scene;
  of_scene.given.reset();
  if (!GivenJoints::givesAll(start.given)) {
    of_scene.given = namesOf(mechanism, scene, start.given);
  }
  Scene of_motion = of_scene;
  placeGiven(mechanism, start, of_motion);
  const Trial from_scene = tried(mechanism, of_scene, start);
  if (!from_scene.open && from_scene.leads && from_scene.way <= kSensible) return of_scene;
  const Trial from_motion = tried(mechanism, of_motion, start);
  if (from_scene.open && from_motion.open) std::rethrow_exception(from_motion.open);
  return prefersMotion(from_scene, from_motion) ? of_motion : of_scene;
}

}  // namespace virtual_work_dynamics
