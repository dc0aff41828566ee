#pragma once

#include "core/point_springs.h"
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

}  // namespace virtual_work_dynamics
