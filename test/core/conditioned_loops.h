#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "loops/assembly.h"
#include "loops/completion.h"
#include "loops/forces.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// Roundings of a few ten operations with numbers up to a hundred.
constexpr double kConditionTolerance = 1e-12;
/// Compares moments with forces; no result depends on it, and it shows where a unit is forgotten.
constexpr double kConditionLength = 0.7;

inline void expectNear(const Eigen::VectorXd& expected, const Eigen::VectorXd& found) {
  ASSERT_EQ(expected.size(), found.size());
  ASSERT_TRUE(found.allFinite());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(expected[i], found[i], kConditionTolerance * std::max(1.0, std::abs(expected[i])))
        << i;
  }
}

/// Dynamics like ClosedLoopDynamics, with conditions that a scene cannot have.
struct ConditionedLoops {
  ConditionedLoops(const Mechanism& robot, const Scene& scene, const ConditionSets& more)
      : mechanism(robot),
        resolved(resolveLoopScene(robot, scene)),
        kinematics(robot, joined(makeConditions(robot, scene), more)),
        groups(loopGroups(robot, kinematics)),
        completion(robot, kinematics, groups, resolved.rank_tolerance, kConditionLength),
        assembly(assemble(scene, resolved, completion, kinematics)) {
    for (const LoopGroup& group : groups) {
      forces.emplace_back(robot, kinematics, resolved, group, kConditionLength);
    }
  }

  static ConditionSets joined(ConditionSets sets, const ConditionSets& more) {
    sets.insert(sets.end(), more.begin(), more.end());
    return sets;
  }

  bool complete(Motion& motion) {
    return completion.complete(kinematics, motion, resolved.actuated);
  }

  /// Efforts of actuated coordinates; zero elsewhere.
  Eigen::VectorXd efforts(const Motion& motion) {
    Eigen::VectorXd efforts = treeEfforts(motion);
    kinematics.setPosition(motion.q);
    const std::vector<Wrench> no_reactions(mechanism.joints().size());
    for (LoopForces& group : forces) {
      group.setPosition();
      group.solve(efforts, no_reactions);
    }
    for (const LoopForces& group : forces) {
      for (const int i : group.group().coordinates) efforts[i] = 0;
      for (const LoopUnknowns::Effort& effort : group.efforts()) {
        efforts[static_cast<Eigen::Index>(effort.index)] =
            effort.unit * group.solution().x[effort.unknown];
      }
    }
    return efforts;
  }

  Eigen::VectorXd treeEfforts(const Motion& motion) const {
    Request request;
    request.efforts = true;
    const InverseDynamics tree(mechanism, Scene(), request);
    Workspace workspace = tree.makeWorkspace();
    tree.compute(motion, workspace);
    return workspace.effort();
  }

  const Mechanism& mechanism;
  LoopScene resolved;
  LoopKinematics kinematics;
  std::vector<LoopGroup> groups;
  LoopCompletion completion;
  Eigen::VectorXd assembly;
  std::vector<LoopForces> forces;
};

}  // namespace virtual_work_dynamics
