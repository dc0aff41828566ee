#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// Results of one sample by the name of the joint.
class NamedResults {
 public:
  NamedResults(const Mechanism& mechanism, const Scene& scene, const Request& request,
               const Motion& motion, InstructionSet set = chosenInstructionSet())
      : dynamics_(mechanism, scene, request, set), workspace_(dynamics_.makeWorkspace()) {
    dynamics_.compute(motion, workspace_);
  }

  const Eigen::VectorXd& effort() const { return workspace_.effort(); }
  const Wrench& child(const std::string& name) const {
    return workspace_.childAxes()[indexIn(dynamics_.request().child_axes, name)];
  }
  const Wrench& root(const std::string& name) const { return workspace_.rootAxes()[at(name)]; }
  const Pose& pose(const std::string& name) const { return workspace_.poses()[at(name)]; }
  const Twist& twist(const std::string& name) const { return workspace_.twists()[at(name)]; }
  PlanSummary summary() const { return dynamics_.summary(); }

 private:
  static std::size_t indexIn(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  std::size_t at(const std::string& name) const {
    return indexIn(dynamics_.request().root_axes, name);
  }

  InverseDynamics dynamics_;
  Workspace workspace_;
};

/// Compares results as numbers, so that -0 equals 0.
inline void expectSame(const Wrench& a, const Wrench& b) {
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.torque, b.torque);
}

}  // namespace virtual_work_dynamics
