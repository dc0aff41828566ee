#pragma once

#include "loops/point_springs.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

// Scenes of the tree that is left when the closures of a mechanism are cut. Springs and closures
// become applied wrenches in root axes, whose values are set sample by sample.

/// The scene without closures, springs, passive joints and reactions.
Scene withoutLoops(const Scene& scene);

/// The scene without closures. Each spring has two wrenches after the scene's own, on link_a and on
/// link_b.
Scene openTreeScene(const Scene& scene, const PointSprings& springs);

/// The same with reactions of joints that are whole, even where the scene leaves the active part
/// out, and about the joints' origins.
Scene wholeReactionsScene(Scene open_tree);

/// The scene with closures as loads. After the springs' wrenches each closure has two, on its child
/// and on its parent, at the origins of its frames.
Scene closedTreeScene(const Scene& scene, const PointSprings& springs);

/// Whether a name of a reaction is that of a closure, which the tree does not have.
bool isClosure(const Mechanism& mechanism, const std::string& name);

/// The efforts and reactions of a request that the tree has, in its order.
Request treeRequest(const Mechanism& mechanism, const Request& request);

}  // namespace virtual_work_dynamics
