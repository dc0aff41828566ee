#pragma once

#include <string>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// "planar", "cylindrical" and so on, as a scene names the type.
const char* nameOf(CompoundType type);

/// The mechanism with the joints of Scene::joint_types in place of those of the description. A
/// joint with several freedoms is a chain of joints with one each, which are coordinates under the
/// joint's name, a dot and the name of the part: "x", "y" and "angle" of a plane, "slide" and
/// "angle" of a cylindrical joint, "angle1" and "angle2" of a universal one. The one coordinate of
/// a screw, its angle, has the name of the joint. A spherical joint has "rx", "ry" and "rz", which
/// turn on from Motion::orientations; a floating one has "x", "y" and "z" before these. The
/// reaction is that of the joint's own name.
/// @throws SceneError naming the entry whose joint does not exist, is given twice, mimics another
/// or
///   is mimicked, that lacks an axis or pitch or has one too many, or whose axes have no direction
///   or are parallel.
Mechanism withJointTypes(const Mechanism& described, const Scene& scene);

}  // namespace virtual_work_dynamics
