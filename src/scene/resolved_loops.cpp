#include "scene/resolved_loops.h"

#include <cmath>
#include <set>
#include <unordered_map>

#include "base/number_text.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

void requirePositive(const std::string& what, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw SceneError(what + " = " + numberText(value) + " is not a positive number");
}

void requireOnce(const std::string& list, std::set<std::string>& seen, const std::string& name) {
  if (!seen.insert(name).second) throw SceneError(list + ": '" + name + "' is given twice");
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
    loops_.coordinate_weights.assign(coordinates, 1);
    loops_.closure_weights.assign(closures, 1);
    loops_.joint_stiffness.assign(mechanism_.joints().size(), 1);
    loops_.closure_stiffness.assign(closures, 1);
    loops_.zero_at.assign(closures, false);
    loops_.start.setZero(static_cast<Eigen::Index>(coordinates));
    readActuated();
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
      const std::string what = "closures: '" + closure.name + "'";
      if (closure.name.empty()) throw SceneError("closures: a closure has no name");
      if (closure.name == kGround) throw SceneError(what + ": that name is reserved");
      if (mechanism_.jointIndex(closure.name) >= 0) {
        throw SceneError(what + ": a joint has the same name");
      }
      requireOnce("closures", seen, closure.name);
      for (const LinkFrame* frame : {&closure.parent, &closure.child}) {
        if (!frame->xyz.allFinite() || !frame->rpy.allFinite()) {
          throw SceneError(what + ": the frame on '" + frame->link + "' is not finite");
        }
      }
      if (closure.length && !traitsOf(closure.type).hasLength()) {
        throw SceneError(what + ": only a closure of type distance has a length");
      }
      if (closure.length) requirePositive(what + ": length", *closure.length);
    }
  }

  // Finds the coordinate of a joint that neither is fixed nor mimics another one.
  int coordinateOf(const std::string& list, const std::string& name) const {
    const int k = mechanism_.jointIndex(name);
    if (k < 0) throw SceneError(list + ": the robot has no joint '" + name + "'");
    const Joint& joint = mechanism_.joint(k);
    if (joint.type == JointType::kFixed) {
      throw SceneError(list + ": '" + name + "' is a fixed joint");
    }
    if (joint.mimics) throw SceneError(list + ": '" + name + "' mimics another joint");
    return joint.coordinate;
  }

  void readActuated() {
    if (!scene_.actuated) return;
    std::set<std::string> seen;
    std::vector<bool> closures(scene_.closures.size(), false);
    for (const std::string& name : *scene_.actuated) {
      requireOnce("actuated", seen, name);
      const int c = closureIndex(name);
      if (c < 0) {
        loops_.actuated[static_cast<std::size_t>(coordinateOf("actuated", name))] = true;
        continue;
      }
      if (!traitsOf(scene_.closures[static_cast<std::size_t>(c)].type).free_axis) {
        throw SceneError("actuated: closure '" + name + "' is neither revolute nor prismatic");
      }
      closures[static_cast<std::size_t>(c)] = true;
    }
    for (std::size_t c = 0; c < closures.size(); ++c) {
      if (closures[c]) loops_.actuated_closures.push_back(c);
    }
  }

  void readAssembly() {
    std::set<std::string> seen;
    for (const NamedNumber& start : scene_.assembly) {
      requireOnce("assembly", seen, start.name);
      const int coordinate = coordinateOf("assembly", start.name);
      if (!std::isfinite(start.value)) {
        throw SceneError("assembly: '" + start.name + "': the position is not finite");
      }
      loops_.start[coordinate] = start.value;
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
    for (const std::string& name : scene_.redundancy.zero_at) {
      requireOnce("redundancy: zero_at", seen, name);
      const int c = closureIndex(name);
      if (c < 0) throw SceneError("redundancy: zero_at: the scene has no closure '" + name + "'");
      loops_.zero_at[static_cast<std::size_t>(c)] = true;
    }
  }

  void readStiffness() {
    const std::string list = "redundancy: stiffness";
    std::set<std::string> seen;
    for (const NamedNumber& stiffness : scene_.redundancy.stiffness) {
      requireOnce(list, seen, stiffness.name);
      requirePositive(list + ": '" + stiffness.name + "'", stiffness.value);
      const int c = closureIndex(stiffness.name), k = mechanism_.jointIndex(stiffness.name);
      if (c < 0 && k < 0) {
        throw SceneError(list + ": there is no joint or closure '" + stiffness.name + "'");
      }
      if (c < 0 && mechanism_.joint(k).type == JointType::kFixed) {
        throw SceneError(list + ": '" + stiffness.name + "' is a fixed joint");
      }
      (c < 0 ? loops_.joint_stiffness[static_cast<std::size_t>(k)]
             : loops_.closure_stiffness[static_cast<std::size_t>(c)]) = stiffness.value;
    }
  }

  void readWeights() {
    const std::string list = "redundancy: effort_weights";
    std::set<std::string> seen;
    for (const NamedNumber& weight : scene_.redundancy.effort_weights) {
      requireOnce(list, seen, weight.name);
      requirePositive(list + ": '" + weight.name + "'", weight.value);
      const int c = closureIndex(weight.name);
      const int coordinate = c < 0 ? coordinateOf(list, weight.name) : -1;
      const auto& closures = loops_.actuated_closures;
      const bool actuated =
          c < 0 ? loops_.actuated[static_cast<std::size_t>(coordinate)]
                : std::binary_search(closures.begin(), closures.end(), std::size_t(c));
      if (!actuated) throw SceneError(list + ": '" + weight.name + "' is not actuated");
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
