#pragma once

#include <tinyxml2.h>

#include <map>
#include <string>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Orientations of a description's frames, from the `rpy` of its text.
///
/// urdfdom gives orientations as double quaternions, in which the last bits are lost already; a
/// needle-shaped body (axial inertia 1e-9 of the transverse) then loses most of its axial inertia's
/// digits when it is rotated. Frames without `rpy` are absent.
struct UrdfAngles {
  std::map<std::string, Matrix3l> joint_origins;     ///< R_PK by joint name
  std::map<std::string, Matrix3l> inertial_origins;  ///< inertial frame -> link, by link name
};

/// Reads the orientations of a <robot>.
/// @throws UrdfError naming the link or joint when an `rpy` is not three finite numbers.
UrdfAngles readUrdfAngles(const tinyxml2::XMLElement& robot);

}  // namespace virtual_work_dynamics
