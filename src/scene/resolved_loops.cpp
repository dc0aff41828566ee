#include "scene/resolved_loops.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "scene/closure_types.h"
#include "scene/driven.h"
#include "scene/lookup.h"
#include "scene/touch_checks.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

void requirePositive(const std::string& what, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw SceneError(what + " = " + numberText(value) + " is not a positive number");
}

void requireOnce(const std::string& list, std::set<std::string>& seen, const std::string& name) {
  if (!seen.insert(name).second) throw SceneError(list + ": " + inQuotes(name) + " is given twice");
}

constexpr double kRightAngle = 1.5707963267948966;

// How the name of what gives the pose of a link begins.
const std::string kPose = "pose.";

void requireSoundTeeth(const std::string& what, const Closure& closure) {
  const Teeth& teeth = closure.teeth;
  const auto fail = [&](const std::string& why) { throw SceneError(what + ": " + why); };
  if (closure.type == ClosureType::kRack) {
    requirePositive(what + ": radius", teeth.parent_radius);
  } else {
    const double a = teeth.parent_radius, b = teeth.child_radius;
    if (!std::isfinite(a) || !std::isfinite(b) || a == 0 || b == 0) {
      fail("radii are finite numbers other than zero");
    }
    if (a + b == 0 || (a < 0 && b < 0)) {
      fail("radii = [" + numberText(a) + ", " + numberText(b) +
           "]: one of two wheels may have its teeth inside, and the other one is smaller");
    }
    if (std::min(a, b) < 0 && a + b > 0) {
      fail("radii = [" + numberText(a) + ", " + numberText(b) +
           "]: a wheel inside of another is smaller than that");
    }
  }
  if (!(teeth.pressure_angle >= 0) || !(teeth.pressure_angle < kRightAngle)) {
    fail("pressure_angle = " + numberText(teeth.pressure_angle) +
         " is not from 0 to below a right angle");
  }
  if (!(std::abs(teeth.helix_angle) < kRightAngle)) {
    fail("helix_angle = " + numberText(teeth.helix_angle) + " is not below a right angle");
  }
}

class Resolver {
 public:
  Resolver(const Mechanism& mechanism, const Scene& scene) : mechanism_(mechanism), scene_(scene) {
    for (const Closure& closure : scene.closures) {
      index_of_closure_.emplace(closure.name, static_cast<int>(index_of_closure_.size()));
    }
  }

  LoopScene resolve() {
    checkClosures();
    const std::size_t closures = scene_.closures.size();
    const std::size_t coordinates = mechanism_.coordinates().size();
    loops_.actuated.assign(coordinates, !scene_.actuated);
    loops_.residual.assign(coordinates, false);
    loops_.coordinate_weights.assign(coordinates, 1);
    loops_.closure_weights.assign(closures, 1);
    loops_.joint_stiffness.assign(mechanism_.joints().size(), 1);
    loops_.closure_stiffness.assign(closures, 1);
    loops_.zero_at.assign(closures, false);
    loops_.start.setZero(static_cast<Eigen::Index>(coordinates));
    loops_.placed.assign(coordinates, false);
    const std::vector<Driven> driven = drivenBy(mechanism_, scene_);
    readActuated(driven);
    readGiven(driven);
    readAssembly();
    readRedundancy();
    return std::move(loops_);
  }

 private:
  int closureIndex(const std::string& name) const {
    const auto found = index_of_closure_.find(name);
    return found == index_of_closure_.end() ? -1 : found->second;
  }

  void checkClosures() const {
    std::set<std::string> seen;
    for (const Closure& closure : scene_.closures) {
      const std::string what =
          std::string(traitsOf(closure.type).list) + ": " + inQuotes(closure.name);
      if (closure.name.empty()) throw SceneError("closures: a closure has no name");
      if (closure.name == kGround) throw SceneError(what + ": that name is reserved");
      if (mechanism_.jointIndex(closure.name) >= 0 || mechanism_.reactionIndex(closure.name) >= 0) {
        throw SceneError(what + ": a joint has the same name");
      }
      requireOnce("closures", seen, closure.name);
      for (const LinkFrame* frame : {&closure.parent, &closure.child}) {
        if (!frame->xyz.allFinite() || !frame->rpy.allFinite()) {
          throw SceneError(what + ": the frame on " + inQuotes(frame->link) + " is not finite");
        }
      }
      if (closure.length && !traitsOf(closure.type).hasLength()) {
        throw SceneError(what + ": only a closure of type distance has a length");
      }
      if (closure.length) requirePositive(what + ": length", *closure.length);
      if (traitsOf(closure.type).touches()) requireSoundTouch(closure, what);
      if (closure.pulls_only && closure.type != ClosureType::kCylinder) {
        throw SceneError(what + ": only a cylinder is one that pulls only");
      }
      if (traitsOf(closure.type).meshes()) requireSoundTeeth(what, closure);
    }
  }

  // Finds the coordinate of a joint that neither is fixed nor mimics another one.
  int coordinateOf(const std::string& list, const std::string& name, int k) const {
    const Joint& joint = mechanism_.joint(k);
    if (joint.coordinate < 0) {
      throw SceneError(list + ": " + inQuotes(name) + " is a fixed joint");
    }
    if (joint.mimics) throw SceneError(list + ": " + inQuotes(name) + " mimics another joint");
    return joint.coordinate;
  }

  // The joint of a name that is not a closure's.
  int jointOrClosure(const std::string& name, const std::string& place) const {
    const int k = mechanism_.jointIndex(name);
    if (k < 0) failAtUnknown(mechanism_, scene_, name, place);
    return k;
  }

  // Chooses the coordinate of a joint, or all of a joint with several freedoms.
  void choose(const std::string& list, const std::string& name, const std::string& place,
              std::vector<bool>& chosen) const {
    const int whole = mechanism_.jointIndex(name) < 0 ? mechanism_.reactionIndex(name) : -1;
    const CompoundJoint* const compound = whole < 0 ? nullptr : mechanism_.compoundOf(whole);
    const int first = compound ? compound->first : jointOrClosure(name, place);
    const int last = compound ? compound->last : first;
    for (int k = first; k <= last; ++k) {
      if (compound && mechanism_.joint(k).coordinate < 0) continue;
      chosen[static_cast<std::size_t>(coordinateOf(list, name, k))] = true;
    }
  }

  // Whether transmissions that have been read move it: their actuators then deliver its effort.
  bool isMovedByActuators(int coordinate) const {
    const std::string& name = mechanism_.coordinateNames()[static_cast<std::size_t>(coordinate)];
    return scene_.actuators_of.count(name) > 0;
  }

  // Cylinders and what is driven are actuators whether they are named or not.
  void readActuated(const std::vector<Driven>& driven) {
    if (!scene_.actuated && scene_.free_motion) {
      throw SceneError("free_motion: every joint is actuated unless 'actuated' says which are");
    }
    std::set<std::string> seen;
    std::vector<bool> closures(scene_.closures.size(), false);
    for (std::size_t c = 0; c < closures.size(); ++c) {
      closures[c] = scene_.closures[c].type == ClosureType::kCylinder;
    }
    for (const Driven& drive : driven) {
      if (drive.coordinate < 0) closures[drive.closure] = true;
      if (drive.coordinate >= 0 && !isMovedByActuators(drive.coordinate)) {
        loops_.actuated[static_cast<std::size_t>(drive.coordinate)] = true;
      }
    }
    for (std::size_t i = 0; scene_.actuated && i < scene_.actuated->size(); ++i) {
      const std::string& name = (*scene_.actuated)[i];
      requireOnce("actuated", seen, name);
      const int c = closureIndex(name);
      if (c < 0) {
        choose("actuated", name, entryOf("actuated", i), loops_.actuated);
        continue;
      }
      closures[freeAxisOf("actuated", name, c)] = true;
    }
    for (std::size_t c = 0; c < closures.size(); ++c) {
      if (closures[c]) loops_.actuated_closures.push_back(c);
    }
  }

  // The free axis of a closure, which must have one.
  std::size_t freeAxisOf(const std::string& list, const std::string& name, int c) const {
    const auto closure = static_cast<std::size_t>(c);
    if (!traitsOf(scene_.closures[closure].type).free_axis) {
      throw SceneError(list + ": closure " + inQuotes(name) + " is neither revolute nor prismatic");
    }
    return closure;
  }

  void readGiven(const std::vector<Driven>& driven) {
    loops_.given.coordinates = loops_.actuated;
    if (scene_.given) loops_.given.coordinates.assign(loops_.actuated.size(), false);
    for (const Driven& drive : driven) {
      if (drive.coordinate < 0) loops_.given.closures.push_back(drive.closure);
      if (drive.coordinate < 0) continue;
      loops_.given.coordinates[static_cast<std::size_t>(drive.coordinate)] = true;
    }
    if (!scene_.given) return;
    std::set<std::string> seen;
    for (std::size_t i = 0; i < scene_.given->size(); ++i) {
      const std::string& name = (*scene_.given)[i];
      requireOnce("given", seen, name);
      requireNoDrive(name);
      const int c = closureIndex(name);
      if (c >= 0) {
        loops_.given.closures.push_back(freeAxisOf("given", name, c));
      } else if (name.compare(0, kPose.size(), kPose) == 0 && mechanism_.jointIndex(name) < 0) {
        loops_.given.links.push_back(linkOfPose(name.substr(kPose.size()), entryOf("given", i)));
      } else {
        choose("given", name, entryOf("given", i), loops_.given.coordinates);
      }
    }
  }

  void requireNoDrive(const std::string& name) const {
    for (const DriveLaw& drive : scene_.drives) {
      if (drive.name != name) continue;
      throw SceneError("given: " + inQuotes(name) + " has a drive, which says how it moves");
    }
  }

  int linkOfPose(const std::string& link, const std::string& place) const {
    const int index = linkNamed(mechanism_, link, place);
    if (index == 0) throw SceneError(place + ": " + inQuotes(link) + " is the root link");
    return index;
  }

  void readAssembly() {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < scene_.assembly.size(); ++i) {
      const NamedNumber& start = scene_.assembly[i];
      requireOnce("assembly", seen, start.name);
      const int k = jointNamed(mechanism_, start.name, entryOf("assembly", i) + ".name");
      const int coordinate = coordinateOf("assembly", start.name, k);
      if (!std::isfinite(start.value)) {
        throw SceneError("assembly: " + inQuotes(start.name) + ": the position is not finite");
      }
      loops_.start[coordinate] = start.value;
      loops_.placed[static_cast<std::size_t>(coordinate)] = true;
    }
  }

  void readRedundancy() {
    const Redundancy& redundancy = scene_.redundancy;
    requirePositive("redundancy: rank_tolerance", redundancy.rank_tolerance);
    if (redundancy.rank_tolerance >= 1) {
      throw SceneError("redundancy: rank_tolerance = " + numberText(redundancy.rank_tolerance) +
                       " is not less than 1");
    }
    if (redundancy.length) requirePositive("redundancy: length", *redundancy.length);
    loops_.policy = redundancy.policy;
    loops_.rank_tolerance = redundancy.rank_tolerance;
    loops_.length = redundancy.length;
    readZeroAt();
    readStiffness();
    readWeights();
  }

  void readZeroAt() {
    std::set<std::string> seen;
    std::vector<std::string> known;
    for (const Closure& closure : scene_.closures) known.push_back(closure.name);
    for (std::size_t i = 0; i < scene_.redundancy.zero_at.size(); ++i) {
      const std::string& name = scene_.redundancy.zero_at[i];
      requireOnce("redundancy: zero_at", seen, name);
      const int c = closureIndex(name);
      if (c < 0) {
        throw SceneError(entryOf("redundancy.zero_at", i) + ": no closure " + inQuotes(name) +
                         nameHelp(name, known));
      }
      loops_.zero_at[static_cast<std::size_t>(c)] = true;
    }
  }

  void readStiffness() {
    const std::string list = "redundancy: stiffness";
    std::set<std::string> seen;
    for (std::size_t i = 0; i < scene_.redundancy.stiffness.size(); ++i) {
      const NamedNumber& stiffness = scene_.redundancy.stiffness[i];
      requireOnce(list, seen, stiffness.name);
      requirePositive(list + ": " + inQuotes(stiffness.name), stiffness.value);
      const int c = closureIndex(stiffness.name);
      const std::string place = entryOf("redundancy.stiffness", i) + ".name";
      const int k = c < 0 ? mechanism_.reactionIndex(stiffness.name) : -1;
      if (c < 0 && k < 0) failAtUnknown(mechanism_, scene_, stiffness.name, place);
      if (c < 0 && mechanism_.joint(k).type == JointType::kFixed) {
        throw SceneError(list + ": " + inQuotes(stiffness.name) + " is a fixed joint");
      }
      (c < 0 ? loops_.joint_stiffness[static_cast<std::size_t>(k)]
             : loops_.closure_stiffness[static_cast<std::size_t>(c)]) = stiffness.value;
    }
  }

  void readWeights() {
    const std::string list = "redundancy: effort_weights";
    std::set<std::string> seen;
    for (std::size_t i = 0; i < scene_.redundancy.effort_weights.size(); ++i) {
      const NamedNumber& weight = scene_.redundancy.effort_weights[i];
      requireOnce(list, seen, weight.name);
      requirePositive(list + ": " + inQuotes(weight.name), weight.value);
      const int c = closureIndex(weight.name);
      const std::string place = entryOf("redundancy.effort_weights", i) + ".name";
      const int coordinate =
          c < 0 ? coordinateOf(list, weight.name, jointOrClosure(weight.name, place)) : -1;
      const auto& closures = loops_.actuated_closures;
      const bool actuated =
          c < 0 ? loops_.actuated[static_cast<std::size_t>(coordinate)]
                : std::binary_search(closures.begin(), closures.end(), std::size_t(c));
      if (!actuated) throw SceneError(list + ": " + inQuotes(weight.name) + " is not actuated");
      (c < 0 ? loops_.coordinate_weights[static_cast<std::size_t>(coordinate)]
             : loops_.closure_weights[static_cast<std::size_t>(c)]) = weight.value;
    }
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  std::unordered_map<std::string, int> index_of_closure_;
  LoopScene loops_;
};

}  // namespace

LoopScene resolveLoopScene(const Mechanism& mechanism, const Scene& scene) {
  return Resolver(mechanism, scene).resolve();
}

}  // namespace virtual_work_dynamics
