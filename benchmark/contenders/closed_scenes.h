#pragma once

#include <string>
#include <vector>

#include "contenders/robots.h"

namespace virtual_work_dynamics {

/// Names of the scenes with closed loops in the order of the report: the package's examples, then
/// rows of four-bar linkages, separateFourBars() and sharedRods(), by their numbers of loops.
std::vector<std::string> closedSceneNames();

bool isClosedScene(const std::string& name);

/// Whether measuring the scene takes seconds: not part of a quick run.
bool takesSeconds(const std::string& name);

/// The scene with its states: random positions of the actuated joints within a range about the
/// assembly, random velocities and accelerations, and what Dynamics::complete() makes of
/// them on a path of small steps from one state to the next. The same in every run.
/// @throws Error when there is no such scene or the loops do not close on the way, UrdfError,
///   SceneError, FileError.
BenchmarkScene makeClosedScene(const std::string& name);

/// Numbers of what a closed scene consists of.
struct LoopCounts {
  Eigen::Index coordinates = 0;
  std::size_t actuated = 0;
  std::size_t closures = 0;  ///< the same as independent loops
  int conditions = 0;
  int redundant_constraints = 0;
};
/// @throws Error when redundant constraints are more in some states than in others.
LoopCounts countLoops(const BenchmarkScene& scene);

}  // namespace virtual_work_dynamics
