#pragma once

#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The child frames of closures in their links, for /tf_static; ~reaction/<closure> refers to them.
/// @param reactions names of reactions; only closures among them get a frame, except for
///   contacts, whose frames move on their links: see movingContacts().
/// @param frame_prefix put before every frame_id.
/// @throws SceneError when a closure has the name of a link, so that two frames would have it.
tf2_msgs::TFMessage closureFrames(const Mechanism& mechanism, const Scene& scene,
                                  const std::vector<std::string>& reactions,
                                  const std::string& frame_prefix);

/// The frame whose axes and origin a reaction in child axes refers to: the child link's, or the
/// closure's own.
std::string reactionFrame(const Mechanism& mechanism, const std::string& reaction);

}  // namespace virtual_work_dynamics
