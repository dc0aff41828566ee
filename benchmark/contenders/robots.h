#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// States of each scene; contenders go round them.
constexpr std::size_t kStates = 16;

/// A robot with everything that is the same for all who compute its dynamics.
struct BenchmarkScene {
  std::string name;
  Mechanism mechanism;
  Eigen::Vector3d gravity;      ///< m/s^2, axes of the root link
  std::vector<Motion> motions;  ///< kStates random states, the same in every run
  /// The whole scene of a mechanism with closed loops; none: a tree in its field of gravity.
  std::optional<Scene> loops = std::nullopt;
};

/// Names of all scenes in the order of the report: trees, then those with closed loops.
std::vector<std::string> sceneNames();

/// Where a scene's description should be but is not; empty: it can be made. The robots that are no
/// part of the package are read from the folder VWD_SHARED_DATA.
/// @throws Error when there is no scene of that name.
std::string missingFile(const std::string& name);

/// The description of a tree that all contenders are given. @throws Error for an unknown name,
/// FileError.
std::string sceneUrdf(const std::string& name);

/// A scene with its states. @throws as sceneUrdf(), UrdfError, makeClosedScene().
BenchmarkScene makeScene(const std::string& name);

/// A chain of `links` revolute joints with random axes, origins, orientations and inertias that a
/// body can have; links of some centimetres, so that forces stay of one order along long chains.
/// The same text in every run.
std::string chainUrdf(int links);

}  // namespace virtual_work_dynamics
