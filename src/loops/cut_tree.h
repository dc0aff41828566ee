#pragma once

#include "loops/point_springs.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

// Scenes of the tree that a mechanism with loops is when its closures are cut. What springs and
// closures exert are applied wrenches, root axes, whose values are set sample by sample.

/// Without closures, springs and passive joints.
Scene withoutLoops(const Scene& scene);

/// For the efforts without closures. Each spring has two wrenches behind the scene's own, on link_a
/// and on link_b. Joints have their whole reactions, whatever is reported of them.
Scene openTreeScene(const Scene& scene, const PointSprings& springs);

/// For the reactions with closures. Behind the springs' wrenches each closure has two more, on its
/// child and on its parent, at the origins of its frames.
Scene closedTreeScene(const Scene& scene, const PointSprings& springs);

/// Whether a name of a reaction is that of a closure, which the tree does not have.
bool isClosure(const Mechanism& mechanism, const std::string& name);

/// The efforts and reactions of a request that the tree has, in its order.
Request treeRequest(const Mechanism& mechanism, const Request& request);

}  // namespace virtual_work_dynamics
