#pragma once

#include <string>

#include "contenders/contender.h"
#include "contenders/peer_input.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// The request for the outputs of a label: efforts, and with reactions those of every movable joint
/// in the child link's axes.
inline Request ownRequest(const BenchmarkScene& scene, const std::string& outputs) {
  Request request;
  if (outputs == kEffortsAndReactions) {
    for (const int joint : movableJoints(scene.mechanism)) {
      request.child_axes.push_back(scene.mechanism.joints()[joint].name);
    }
  }
  return request;
}

/// The request for the outputs of a label in a scene with closed loops: efforts, and with reactions
/// those of movable joints, then of closures.
inline Request loopRequest(const BenchmarkScene& scene, const std::string& outputs) {
  Request request;
  request.determinacy = request.residuals = false;
  if (outputs == kEffortsAndReactions) {
    request.child_axes = requestedReactions(scene.mechanism, *scene.loops);
  }
  return request;
}

inline Scene ownScene(const BenchmarkScene& benchmark_scene) {
  Scene scene;
  scene.gravity = benchmark_scene.gravity;
  return scene;
}

inline SampleResults plainResults(const Eigen::VectorXd& effort,
                                  const std::vector<Wrench>& child_axes) {
  SampleResults results;
  results.efforts.assign(effort.data(), effort.data() + effort.size());
  for (const Wrench& wrench : child_axes) {
    for (const Eigen::Vector3d& part : {wrench.force, wrench.torque}) {
      results.reactions.insert(results.reactions.end(), part.data(), part.data() + 3);
    }
  }
  return results;
}

}  // namespace virtual_work_dynamics
