#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Number of states of each scene, which contenders go through again and again.
constexpr std::size_t kStates = 16;

/// A robot with everything that is the same for all contenders.
struct BenchmarkScene {
  std::string name;
  Mechanism mechanism;
  Eigen::Vector3d gravity;      ///< m/s^2, axes of the root link
  std::vector<Motion> motions;  ///< kStates random states, the same in every run
  /// The whole scene of a mechanism with closed loops; none: a tree with gravity alone.
  std::optional<Scene> loops = std::nullopt;
};

/// Names of all scenes in the order of the report: trees, then those with closed loops.
std::vector<std::string> sceneNames();

/// The path of a scene's description when it is missing; empty when the scene can be made. Robots
/// that are not part of the package are read from the folder VWD_SHARED_DATA.
/// @throws Error when there is no scene of that name.
std::string missingFile(const std::string& name);

/// The description of a tree that all contenders are given. @throws Error for an unknown name,
/// FileError.
std::string sceneUrdf(const std::string& name);

/// Makes a scene with its states. @throws UrdfError, and as sceneUrdf() and makeClosedScene().
BenchmarkScene makeScene(const std::string& name);

/// The description of a chain of `links` revolute joints with random axes, origins, orientations
/// and inertias that a body can have. Links are some centimetres long, so that forces stay of one
/// order along long chains. The text is the same in every run.
std::string chainUrdf(int links);

}  // namespace virtual_work_dynamics
