#include "ros/given_lengths.h"

#include "base/printable.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/drives.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

std::vector<std::string> givenLengths(const Mechanism& mechanism, const Scene& scene,
                                      const Given& given) {
  std::vector<std::string> names;
  for (std::size_t i = Drives(mechanism, scene).closures().size(); i < given.closures.size(); ++i) {
    names.push_back(scene.closures[given.closures[i]].name);
  }
  return names;
}

Given withoutLengths(const Mechanism& mechanism, const Scene& scene, const Given& given) {
  Given rest = given;
  rest.closures.resize(Drives(mechanism, scene).closures().size());
  return rest;
}

void requireLengths(const Mechanism& mechanism, const Scene& scene, const Given& given) {
  const std::string refused =
      "given: joint states have joints and lengths of cylinders and slides, but not ";
  for (std::size_t i = Drives(mechanism, scene).closures().size(); i < given.closures.size(); ++i) {
    const Closure& closure = scene.closures[given.closures[i]];
    if (traitsOf(closure.type).free_axis == Unit::kMetre) continue;
    throw SceneError(refused + "the angle of " + inQuotes(closure.name));
  }
  if (given.links.empty()) return;
  throw SceneError(refused + "the pose of " + inQuotes(mechanism.link(given.links.front()).name));
}

}  // namespace virtual_work_dynamics
