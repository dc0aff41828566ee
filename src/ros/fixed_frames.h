#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "ros/rejection.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// A frame that does not move against a link: v_link = R v_frame, and its origin in link axes, m.
struct FixedFrame {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// Finds the frame of a link of the robot that is `link`, or hangs together with it by fixed
/// joints.
/// @param prefix what stands before the names of links in every frame_id
/// @param id frame_id of a message
/// @returns why the message is to be dropped, or nothing.
std::optional<Rejection> findFixedFrame(const Mechanism& mechanism, const std::string& prefix,
                                        const std::string& id, int link, FixedFrame& frame);

/// Finds the link that moves, or is the root, with which the frame of a link hangs together by
/// fixed joints.
/// @param frame receives its pose in that link
std::optional<Rejection> findCarryingLink(const Mechanism& mechanism, const std::string& prefix,
                                          const std::string& id, int& link, FixedFrame& frame);

}  // namespace virtual_work_dynamics
