#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What a scene says about loops, with its names resolved.
struct LoopScene {
  std::vector<bool> actuated;                  ///< by coordinate; with those of residual
  std::vector<bool> residual;                  ///< by coordinate, see chooseResidual()
  std::vector<std::size_t> actuated_closures;  ///< in the scene's order
  Given given;                                 ///< what motions give
  std::vector<double> coordinate_weights;      ///< of efforts, by coordinate
  std::vector<double> closure_weights;         ///< of efforts, by closure
  std::vector<double> joint_stiffness;         ///< by joint
  std::vector<double> closure_stiffness;       ///< by closure
  std::vector<bool> zero_at;                   ///< by closure
  RedundancyPolicy policy = RedundancyPolicy::kMinimumNorm;
  double rank_tolerance = 0;
  std::optional<double> length;
  Eigen::VectorXd start;     ///< where the assembly starts, by coordinate
  std::vector<bool> placed;  ///< whether the scene says where, by coordinate
};

/// Resolves the names of a scene.
/// @throws SceneError naming what is unknown, given twice, out of range or of the wrong kind.
LoopScene resolveLoopScene(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
