#pragma once

#include <string>

#include "ros/private_parameters.h"

namespace virtual_work_dynamics {

/// Which messages tell how the root link moves.
enum class RootSource { kNone, kOdometry, kTrajectory, kStates, kTf, kImu };

/// Reads ~root/source; none when it is empty.
/// @throws ParameterError for a word that is no source.
RootSource readRootSource(PrivateParameters& parameters);

/// In which axes ~reactions and ~reactions_inertial have wrenches and poses.
enum class RootAxes { kRoot, kInertial, kBoth };

/// Reads ~root/axes.
/// @throws ParameterError for a word that is none of root, inertial and both, and for inertial axes
///   where the root link rests.
RootAxes readRootAxes(PrivateParameters& parameters, RootSource source);

/// How the node learns how the root link moves.
struct RootSettings {
  RootSource source = RootSource::kNone;
  std::string inertial_frame = "odom";  ///< frame_id of the frame that motions are against
  RootAxes axes = RootAxes::kRoot;      ///< of results
  std::string link;      ///< what messages call the root link; empty: as its own frame_id is
  double timeout = 0.1;  ///< longest time that a motion is foreseen behind the newest message, s
};

}  // namespace virtual_work_dynamics
