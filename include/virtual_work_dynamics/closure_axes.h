#pragma once

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"
#include "virtual_work_dynamics/transmissions.h"

namespace virtual_work_dynamics {

/// The mechanism in which the free axes of those closures are coordinates that couplings name, and
/// the scene that goes with it. In place of such a closure the mechanism has a joint of its name,
/// on its parent frame, with a link of that name that has no mass, which a closure `name.fixed`
/// fixes to the child frame. What the scene says of the closure holds for the joint: in `actuated`,
/// `given`, `reactions`, `moments_about` and `redundancy`; its reaction is what it was. It starts
/// where the assembly has the closure, and counts whole turns from there on.
/// @param mechanism as withTransmissions() makes it
/// @throws SceneError naming the coupling whose closure has not one free axis, and the closure
/// whose
///   name is that of a link.
SceneOfMechanism withClosureAxes(const Mechanism& mechanism, const Scene& scene);

/// The name of the closure that `closure` of what withClosureAxes() returns is the rest of; empty
/// for others, whatever their names.
std::string axisOfClosure(const Mechanism& mechanism, const Scene& scene, const Closure& closure);

/// The mechanism and scene that are computed: withJointTypes(), withTransmissions() and
/// withClosureAxes(), one after the other.
/// @throws SceneError as they do.
SceneOfMechanism mechanismFor(const Mechanism& described, const Scene& scene);

}  // namespace virtual_work_dynamics
