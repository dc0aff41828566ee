#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "closed_loops.h"

namespace virtual_work_dynamics {

/// The results of ClosedLoopDynamics that a scene asks for, by name.
class ClosedLoopResults {
 public:
  ClosedLoopResults(const Mechanism& mechanism, const Scene& scene)
      : dynamics(mechanism, scene, everythingOf(mechanism, scene)) {}
  ClosedLoopResults(const Mechanism& mechanism, const Scene& scene, const Motion& motion)
      : ClosedLoopResults(mechanism, scene) {
    dynamics.compute(motion);
  }

  const Wrench& child(const std::string& name) const { return dynamics.childAxes()[indexOf(name)]; }
  const Wrench& root(const std::string& name) const { return dynamics.rootAxes()[indexOf(name)]; }
  const Determined& childDetermined(const std::string& name) const {
    return dynamics.childAxesDetermined()[indexOf(name)];
  }
  const Determined& rootDetermined(const std::string& name) const {
    return dynamics.rootAxesDetermined()[indexOf(name)];
  }

  ClosedLoops dynamics;

 private:
  static Request everythingOf(const Mechanism& mechanism, const Scene& scene) {
    Request request;
    request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
    return request;
  }
  std::size_t indexOf(const std::string& name) const {
    const auto& names = dynamics.request().child_axes;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }
};

}  // namespace virtual_work_dynamics
