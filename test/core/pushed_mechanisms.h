#pragma once

#include <string>
#include <vector>

#include "four_bar.h"
#include "plain_results.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {

/// A wrench that turns and pushes.
inline AppliedWrench push(const std::string& link, Axes axes) {
  AppliedWrench push;
  push.link = link;
  push.axes = axes;
  push.at << 0.2, 0.1, -0.3;
  push.force << 10, -20, 5;
  push.torque << 1, 2, 3;
  return push;
}

/// Other values of the scene's applied wrenches.
inline Load otherLoad(const Scene& scene) {
  Load load(scene);
  for (Wrench& wrench : load.wrenches) {
    wrench.force = Eigen::Vector3d(-3, 7, wrench.force.x());
    wrench.torque *= -2;
  }
  return load;
}

/// A random tree that is pushed, everything requested.
struct OpenChain {
  OpenChain() {
    for (const char* link : {"link_3", "link_7"}) {
      for (const Axes axes : {Axes::kLink, Axes::kRoot}) {
        scene.applied_wrenches.push_back(push(link, axes));
      }
    }
  }

  RandomRobot robot{101, 10};
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene;
  const Request request = requestEveryJoint(mechanism);
};

/// The four-bar, cut at its last joint, with a spring and a wrench on it; everything requested.
struct ClosedLinkage {
  explicit ClosedLinkage(const std::vector<std::string>& actuated = {"A"}) {
    PointSpring spring;
    spring.name = "spring";
    spring.link_a = "base";
    spring.link_b = "coupler";
    spring.at_b << 0.3, 0.1, 0;
    spring.stiffness = 30;
    cut.scene.springs = {spring};
    cut.scene.applied_wrenches = {push("coupler", Axes::kRoot), push("rocker", Axes::kLink)};
    cut.scene.actuated = actuated;
    request.child_axes = {"D", "A", "B", "C", kGround};
    request.root_axes = {kGround, "C", "D", "A", "B"};
    request.poses = request.twists = true;
  }

  Motion motion(long double angle) const { return cut.motion(bars.turnings(angle, 3, -2)); }
  /// The passive joints as they were before.
  Motion incomplete(long double angle) const {
    Motion from = motion(angle - 0.02L);
    const Motion to = motion(angle);
    from.q[0] = to.q[0];
    from.qd[0] = to.qd[0];
    from.qdd[0] = to.qdd[0];
    return from;
  }

  const FourBar bars;
  FourBar::Cut cut = bars.cut('D');
  Request request;
};

}  // namespace virtual_work_dynamics
