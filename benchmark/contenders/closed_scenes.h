#pragma once

#include <string>
#include <vector>

#include "contenders/robots.h"

namespace virtual_work_dynamics {

/// Names of the scenes with closed loops in the order of the report: the package's examples, then
/// rows of four-bar linkages, separateFourBars() and sharedRods(), by their numbers of loops.
std::vector<std::string> closedSceneNames();

bool isClosedScene(const std::string& name);

/// Whether measuring the scene takes seconds, so that it is not part of a quick run.
bool takesSeconds(const std::string& name);

/// Makes the scene with its states, the same in every run. Actuated joints have random positions
/// within a range about the assembly, and random velocities and accelerations;
/// Dynamics::complete() adds the other joints on a path of small steps from one state to the next.
/// @throws Error when there is no such scene or the loops do not close on the way, UrdfError,
///   SceneError, FileError.
BenchmarkScene makeClosedScene(const std::string& name);

/// The size of a scene with closed loops.
struct LoopCounts {
  Eigen::Index coordinates = 0;
  std::size_t actuated = 0;
  std::size_t closures = 0;  ///< as many as independent loops
  int conditions = 0;
  int redundant_constraints = 0;
};
/// Counts what a scene with closed loops consists of.
/// @throws Error when some states have more redundant constraints than others.
LoopCounts countLoops(const BenchmarkScene& scene);

}  // namespace virtual_work_dynamics
