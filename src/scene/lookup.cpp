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

// The names of the joints' reactions.
std::vector<std::string> reactionNames(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (int k = 0; k < static_cast<int>(mechanism.joints().size()); ++k) {
    if (!mechanism.isInnerPart(k)) names.push_back(mechanism.reactionName(k));
  }
  return names;
}

// Refuses a part of a compound joint where only the whole one can stand, and the other way round.
void refuseParts(const Mechanism& mechanism, const std::string& name, const std::string& place) {
  const int joint = mechanism.jointIndex(name);
  if (joint >= 0 && mechanism.compoundOf(joint)) {
    throw SceneError(place + ": " + inQuotes(name) + " is a part of joint " +
                     inQuotes(mechanism.compoundOf(joint)->name) + ", whose reaction is one");
  }
}

void refuseWhole(const Mechanism& mechanism, const std::string& name, const std::string& place) {
  const int joint = mechanism.reactionIndex(name);
  const CompoundJoint* const compound = joint < 0 ? nullptr : mechanism.compoundOf(joint);
  if (!compound) return;
  std::vector<std::string> parts;
  for (int k = compound->first; k <= compound->last; ++k) {
    if (mechanism.joint(k).coordinate >= 0) parts.push_back(mechanism.joint(k).name);
  }
  throw SceneError(place + ": joint " + inQuotes(name) + " has several freedoms, name one of " +
                   namesInQuotes(parts));
}

}  // namespace

std::string entryOf(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

int jointNamed(const Mechanism& mechanism, const std::string& name, const std::string& place) {
  const int joint = mechanism.jointIndex(name);
  if (joint < 0) refuseWhole(mechanism, name, place);
  if (joint < 0) fail(place, "joint", name, namesOf(mechanism.joints()));
  return joint;
}

int reactionNamed(const Mechanism& mechanism, const std::string& name, const std::string& place) {
  const int joint = mechanism.reactionIndex(name);
  if (joint < 0) refuseParts(mechanism, name, place);
  if (joint < 0) fail(place, "joint", name, reactionNames(mechanism));
  return joint;
}

int linkNamed(const Mechanism& mechanism, const std::string& name, const std::string& place) {
  const int link = mechanism.linkIndex(name);
  if (link < 0) fail(place, "link", name, namesOf(mechanism.links()));
  return link;
}

void failAtUnknown(const Mechanism& mechanism, const Scene& scene, const std::string& name,
                   const std::string& place) {
  refuseWhole(mechanism, name, place);
  refuseParts(mechanism, name, place);
  std::vector<std::string> known = namesOf(mechanism.joints());
  for (const Closure& closure : scene.closures) known.push_back(closure.name);
  fail(place, scene.closures.empty() ? "joint" : "joint or closure", name, known);
}

}  // namespace virtual_work_dynamics
