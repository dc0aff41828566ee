#include "scene/lookup.h"

#include "base/nearest_name.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

template <typename Named>
std::vector<std::string> namesOf(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& item : list) names.push_back(item.name);
  return names;
}

[[noreturn]] void fail(const std::string& place, const std::string& kind, const std::string& name,
                       const std::vector<std::string>& known) {
  throw SceneError(place + ": no " + kind + " " + inQuotes(name) + nameHelp(name, known));
}

}  // namespace

std::string entryOf(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

int jointNamed(const Mechanism& mechanism, const std::string& name, const std::string& place) {
  const int joint = mechanism.jointIndex(name);
  if (joint < 0) fail(place, "joint", name, namesOf(mechanism.joints()));
  return joint;
}

int linkNamed(const Mechanism& mechanism, const std::string& name, const std::string& place) {
  const int link = mechanism.linkIndex(name);
  if (link < 0) fail(place, "link", name, namesOf(mechanism.links()));
  return link;
}

int closureIndex(const Scene& scene, const std::string& name) {
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    if (scene.closures[c].name == name) return static_cast<int>(c);
  }
  return -1;
}

void failAtUnknown(const Mechanism& mechanism, const Scene& scene, const std::string& name,
                   const std::string& place) {
  std::vector<std::string> known = namesOf(mechanism.joints());
  for (const Closure& closure : scene.closures) known.push_back(closure.name);
  fail(place, scene.closures.empty() ? "joint" : "joint or closure", name, known);
}

}  // namespace virtual_work_dynamics
