#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// A compound joint that is wanted in place of a joint of a mechanism, whose frame it takes over.
struct CompoundWish {
  int joint = 0;  ///< index of the joint, or of any part of the compound joint, that it replaces
  CompoundType type = CompoundType::kPlanar;
  Vector3l axis = Vector3l::UnitZ();   ///< unit vector in that frame; of a plane its normal
  Vector3l axis2 = Vector3l::UnitX();  ///< of a universal joint, the child's: not parallel to axis
  double pitch = 0;                    ///< of a screw, m per revolution
};

/// The part of the name of each part of a type behind that of the joint: "x" of "joint.x". That
/// of a screw is empty, as its one coordinate has the joint's own name.
std::vector<const char*> partNames(CompoundType type);

/// The mechanism with chains of joints of one freedom for what is wished, each joint once. The
/// slides of a plane are along x and y of the frame where its normal is z; where it is x or y,
/// along the next two axes in turn; where it is oblique, the first is normal to the axis of the
/// frame that the normal is farthest from. Damping, friction and limits of the joint that is
/// replaced stay with the part that moves as it did, if any.
/// @throws UrdfError naming a joint that mimics, or that others mimic where its coordinate is lost,
///   and a part whose name is that of another joint or link.
Mechanism withCompounds(const Mechanism& mechanism, const std::vector<CompoundWish>& wishes);

}  // namespace virtual_work_dynamics
