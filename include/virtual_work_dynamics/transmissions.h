#pragma once

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A mechanism and the scene that goes with it.
struct SceneOfMechanism {
  Mechanism mechanism;
  Scene scene;
};

/// The mechanism with the actuators of those transmissions that the scene asks for, and the scene
/// that says how they move its joints. An actuator is a coordinate of its name, the turn of a link
/// without mass beside the joints that it moves, and a coupling `transmission.actuator` ties it to
/// them as the classes of transmission_interface do: with reductions a of actuators and j of
/// joints, and joints' positions x from their offsets,
/// - SimpleTransmission: a1 x1,
/// - DifferentialTransmission: a1 (j1 x1 + j2 x2) and a2 (j1 x1 - j2 x2),
/// - FourBarLinkageTransmission: a1 j1 x1 and a2 (x1 + j2 x2).
/// In `actuated` such joints stand for the actuators that move them, and `drives` of joints are
/// delivered by them; motions give joints unless `given` says otherwise, and where wheels, blades
/// or rates leave positions open, or loops move freely, everything: the programs let actuators
/// follow from the joints there. ReactionSelection::kAll is without the actuators. A doubt says
/// which transmissions have been read.
/// @param mechanism as withJointTypes() makes it
/// @throws SceneError naming the transmission that does not exist, is of another type, lacks a
///   number or role, or whose joints or actuators cannot be what it says.
SceneOfMechanism withTransmissions(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
