#pragma once

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A mechanism with the scene that closes its loops.
struct Linkage {
  Mechanism mechanism;
  Scene scene;
};

/// Planar four-bar linkages side by side on one base, `loops` of them, each driven at its crank:
/// two rods of 0.20 m and 0.26 m hang 0.3 m apart, their tips level, and a coupler joins the tips.
/// Joints turn about parallel axes in space, so that each loop has three redundant constraints, all
/// out of plane.
Linkage separateFourBars(int loops);

/// Planar four-bar linkages in one piece: a row of loops + 1 hanging rods, each joined to the next
/// by a coupler, so that neighbouring loops share a rod. The row has one degree of freedom and is
/// driven at the first rod. Long and short rods take turns, so that no loop is a parallelogram and
/// each undoes how the one before it changed the angle. With level tips this is exact except for
/// the fourth power of the angle; with others, squares of it would add up until long rows could not
/// move.
Linkage sharedRods(int loops);

}  // namespace virtual_work_dynamics
