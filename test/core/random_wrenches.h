#pragma once

#include <string>

#include "sample_robots.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Adds four applied wrenches on links drawn from the first `links` of a random robot, two in link
/// axes and two in root axes.
inline void addAppliedWrenches(RandomRobot& random, int links, Scene& scene) {
  for (const Axes axes : {Axes::kLink, Axes::kRoot, Axes::kLink, Axes::kRoot}) {
    AppliedWrench wrench;
    wrench.link = "link_" + std::to_string(random.pick(links));
    wrench.axes = axes;
    for (auto* vector : {&wrench.at, &wrench.force, &wrench.torque}) {
      *vector << random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2);
    }
    scene.applied_wrenches.push_back(wrench);
  }
}

}  // namespace virtual_work_dynamics
