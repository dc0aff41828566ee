#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ros/outputs.h"

namespace virtual_work_dynamics {

/// Which reactions of a scene are those of contacts, whose frames move on their links, so that /tf
/// has them. Not those whose moments are asked for about other points.
std::vector<std::string> movingContacts(const Scene& scene,
                                        const std::vector<std::string>& reactions);

/// Makes the output of these frames in the root link's, on /tf, which ~reaction/<contact> refers
/// to: where they are measured to be, not where a trajectory is planned to lead.
/// @param rate largest one of its messages, Hz
std::unique_ptr<Output> makeContactFrames(std::vector<std::string> contacts,
                                          const std::string& root_frame,
                                          const std::string& frame_prefix, double rate);

}  // namespace virtual_work_dynamics
