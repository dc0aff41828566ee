#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// What was found about some of the RootCoordinates, which the report has as its joints.
struct RootEstimate {
  std::vector<std::string> names;
  CompletionReport report;
};

/// Estimates what MotionTable::roots of a recording lack, see roots_lack: the linear accelerations
/// from positions, and angular velocities and accelerations from orientations, by the
/// RootCoordinates and completeMotion(). Velocities that are given count by their own noise. Where
/// accelerations are estimated, positions, orientations and velocities become the smoothed ones as
/// well; accelerations that are given stay. Does nothing where nothing is missing. With
/// CompletionSettings::covariances it fills in MotionTable::root_covariances, in which what is
/// given is exact. Allocates.
/// @param settings of the joints; noises and bandwidth are found from the rows all the same
/// @returns what was estimated
/// @throws MotionError for accelerations without positions, too few rows, or times that do not
///   increase, naming the row counted from 1.
std::vector<RootEstimate> completeRoots(const Mechanism& mechanism, MotionTable& motion,
                                        const CompletionSettings& settings);

}  // namespace virtual_work_dynamics
