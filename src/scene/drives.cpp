#include "virtual_work_dynamics/drives.h"

#include <algorithm>
#include <set>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/closure_types.h"
#include "scene/drive_functions.h"
#include "scene/driven.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

std::string placeOfDrive(const std::string& name) {
  return "drives: " + inQuotes(name);
}

int drivenCoordinate(const Mechanism& mechanism, const std::string& name, int joint) {
  const CompoundJoint* const compound = mechanism.compoundOf(joint);
  if (compound && compound->turnsFreely() && joint > compound->last - 3) {
    throw SceneError(placeOfDrive(name) + " is an angle of a joint that turns freely");
  }
  const Joint& driven = mechanism.joint(joint);
  if (driven.coordinate < 0) throw SceneError(placeOfDrive(name) + " is a fixed joint");
  if (driven.mimics) throw SceneError(placeOfDrive(name) + " mimics another joint");
  return driven.coordinate;
}

Driven drivenAt(const Mechanism& mechanism, const Scene& scene, std::size_t index) {
  const std::string& name = scene.drives[index].name;
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    if (scene.closures[c].name != name) continue;
    if (traitsOf(scene.closures[c].type).free_axis) return {-1, c};
    throw SceneError(placeOfDrive(name) +
                     ": only a closure of type revolute or prismatic and a cylinder have an axis "
                     "that can be driven");
  }
  const int joint = mechanism.jointIndex(name);
  if (joint >= 0) return {drivenCoordinate(mechanism, name, joint), 0};
  const std::string place = entryOf("drives", index) + ".name";
  if (mechanism.reactionIndex(name) >= 0) jointNamed(mechanism, name, place);  // names its parts
  failAtUnknown(mechanism, scene, name, place);
}

}  // namespace

std::vector<Driven> drivenBy(const Mechanism& mechanism, const Scene& scene) {
  std::vector<Driven> driven;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < scene.drives.size(); ++i) {
    const std::string& name = scene.drives[i].name;
    if (!seen.insert(name).second) throw SceneError(placeOfDrive(name) + " is given twice");
    driven.push_back(drivenAt(mechanism, scene, i));
  }
  return driven;
}

struct Drives::Target {
  Driven driven;
  double offset;
  std::unique_ptr<const TimeFunction> function;
};

Drives::Drives(const Mechanism& mechanism, const Scene& scene)
    : coordinates_(mechanism.coordinates().size(), false),
      static_motion_(scene.static_motion),
      now_(1) {
  const std::vector<Driven> driven = drivenBy(mechanism, scene);
  for (std::size_t i = 0; i < driven.size(); ++i) {
    const DriveLaw& law = scene.drives[i];
    names_.push_back(law.name);
    if (driven[i].coordinate < 0) {
      closures_.push_back(driven[i].closure);
    } else {
      coordinates_[static_cast<std::size_t>(driven[i].coordinate)] = true;
    }
    targets_.push_back({driven[i], law.offset, timeFunction(law, placeOfDrive(law.name))});
  }
}

Drives::~Drives() = default;
Drives::Drives(Drives&&) noexcept = default;
Drives& Drives::operator=(Drives&&) noexcept = default;

std::optional<std::size_t> Drives::evaluate(double t, const Given& given, Motion& motion,
                                            Motion& driven) {
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const Target& target = targets_[i];
    if (!(t >= target.function->begin() && t <= target.function->end())) return i;
    target.function->evaluate(t, now_);
    if (static_motion_) now_.qd[0] = now_.qdd[0] = 0;
    Motion& to = target.driven.coordinate < 0 ? driven : motion;
    Eigen::Index place = target.driven.coordinate;
    if (place < 0) {
      const auto& closures = given.closures;
      place = std::find(closures.begin(), closures.end(), target.driven.closure) - closures.begin();
    }
    to.q[place] = target.offset + now_.q[0];
    to.qd[place] = now_.qd[0];
    to.qdd[place] = now_.qdd[0];
  }
  return std::nullopt;
}

std::string Drives::whyNone(std::size_t drive, double t) const {
  const TimeFunction& function = *targets_[drive].function;
  const bool early = t < function.begin();
  return placeOfDrive(names_[drive]) + " has no motion at " + numberText(t) + " s: it " +
         (early ? "moves when its function begins, at " + numberText(function.begin())
                : "still moves when its function ends, at " + numberText(function.end())) +
         " s";
}

}  // namespace virtual_work_dynamics
