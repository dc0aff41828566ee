#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

/// All results of ClosedLoopDynamics for one sample, by name.
class NamedLoopResults {
 public:
  NamedLoopResults(const Mechanism& mechanism, const Scene& scene, const Motion& motion)
      : mechanism_(mechanism),
        names_(namesOf(mechanism, scene)),
        dynamics_(mechanism, scene, request()) {
    dynamics_.compute(motion);
  }

  static std::vector<std::string> namesOf(const Mechanism& mechanism, const Scene& scene) {
    std::vector<std::string> names{kGround};
    for (int k = 0; k < static_cast<int>(mechanism.joints().size()); ++k) {
      if (!mechanism.isInnerPart(k)) names.push_back(mechanism.reactionName(k));
    }
    for (const Closure& closure : scene.closures) names.push_back(closure.name);
    return names;
  }

  /// Names of the reactions: "ground", joints, closures.
  const std::vector<std::string>& names() const { return names_; }
  const ClosedLoops& dynamics() const { return dynamics_; }

  double effort(const std::string& joint) const { return dynamics_.effort()[coordinate(joint)]; }
  bool effortDetermined(const std::string& joint) const {
    return dynamics_.effortDetermined().at(static_cast<std::size_t>(coordinate(joint)));
  }
  const Wrench& rootAxes(const std::string& name) const { return dynamics_.rootAxes()[at(name)]; }
  const Wrench& childAxes(const std::string& name) const { return dynamics_.childAxes()[at(name)]; }
  const Determined& rootAxesDetermined(const std::string& name) const {
    return dynamics_.rootAxesDetermined()[at(name)];
  }
  const Determined& childAxesDetermined(const std::string& name) const {
    return dynamics_.childAxesDetermined()[at(name)];
  }

 private:
  Request request() const {
    Request request;
    request.child_axes = request.root_axes = names_;
    return request;
  }

  std::size_t at(const std::string& name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) throw SceneError("no reaction of '" + name + "'");
    return static_cast<std::size_t>(found - names_.begin());
  }

  Eigen::Index coordinate(const std::string& joint) const {
    return mechanism_.joints()
        .at(static_cast<std::size_t>(mechanism_.jointIndex(joint)))
        .coordinate;
  }

  const Mechanism& mechanism_;
  std::vector<std::string> names_;
  ClosedLoops dynamics_;
};

/// Component i of a wrench, 0 to 5: fx fy fz tx ty tz.
inline double component(const Wrench& wrench, int i) {
  return i < 3 ? wrench.force[i] : wrench.torque[i - 3];
}

}  // namespace virtual_work_dynamics
