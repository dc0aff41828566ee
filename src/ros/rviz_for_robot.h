#pragma once

namespace virtual_work_dynamics {

/// The program rviz_for_robot (see its usage). Becomes RViz, or prints.
/// @returns the exit code: 1 where something is wrong with the input, 2 for wrong usage.
int rvizForRobot(int argc, char** argv);

}  // namespace virtual_work_dynamics
