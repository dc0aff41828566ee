#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ros/outputs.h"

namespace virtual_work_dynamics {

/// Makes ~markers, for RViz: at the origin of each reaction, arrows of force and moment and a text
/// with their magnitudes, and a legend of the arrows' lengths, which are those of rviz_for_robot.
/// Some samples are left out, so that there are no more than OutputSettings::marker_rate messages a
/// second.
/// @param frames of ~reaction/<name>, by reaction
/// @param root_frame of the legend
std::unique_ptr<Output> makeMarkerOutput(const Mechanism& mechanism, const OutputSettings& settings,
                                         const std::vector<std::string>& frames,
                                         const std::string& root_frame);

}  // namespace virtual_work_dynamics
