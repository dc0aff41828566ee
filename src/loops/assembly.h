#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "loops/completion.h"
#include "loops/forces.h"
#include "loops/kinematics.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Ends of a rod or spring closer than this fraction of the loops' length give it no direction.
constexpr double kCoincide = 1e-9;

/// Closes the loops at the solution nearest to the scene's start, whichever of a closure's links is
/// the parent, and leaves `kinematics` there. Coordinates that motions give, usually the actuated
/// ones, stay where they start whenever the loops can be closed so; otherwise they move when there
/// are more of them than degrees of freedom.
/// @throws AssemblyError naming the closure that stays open furthest, and by how much, or one that
///   has no sense where it is closed: another start may lead to where it has.
Eigen::VectorXd assemble(const Scene& scene, const LoopScene& loops, LoopCompletion& completion,
                         LoopKinematics& kinematics);

/// Says of each coordinate of loops that is assembled more than 1.5 rad, or the length, from its
/// start how far that is, in one line.
std::vector<std::string> farFromStart(const Mechanism& mechanism, const LoopKinematics& kinematics,
                                      const Eigen::VectorXd& start, const Eigen::VectorXd& assembly,
                                      double length);

/// Finds a position close to the assembly at which the loops are closed. It is regular even where
/// the assembly is singular, unless the mechanism is singular everywhere. Returns the assembly
/// itself where the loops cannot be closed beside it. Moves `kinematics`.
Eigen::VectorXd positionBeside(const Eigen::VectorXd& assembly, const Mechanism& mechanism,
                               LoopCompletion& completion, LoopKinematics& kinematics);

/// Of the coordinates that take part in motions that nothing holds close to the assembly, the one
/// that takes the largest part, one that the scene says motions give before any other; -1 when all
/// is held. Taking one after the other is the choice of independent coordinates of R. A. Wehage and
/// E. J. Haug, "Generalized coordinate partitioning for dimension reduction in analysis of
/// constrained dynamic systems", Journal of Mechanical Design 104 (1982), with orthonormal motions
/// in place of their triangular factorization. `kinematics` returns to the assembly.
int freestCoordinate(const Mechanism& mechanism, const LoopScene& loops,
                     const Eigen::VectorXd& assembly, LoopCompletion& completion,
                     LoopKinematics& kinematics, std::vector<LoopForces>& forces);

/// Checks that every motion of the mechanism is held by an actuated joint, at the assembly or at a
/// position close to it, so that a singular assembly passes; `kinematics` returns to the assembly.
/// @throws SceneError naming the coordinates that nothing holds.
void requireHeld(const Mechanism& mechanism, const LoopScene& loops,
                 const Eigen::VectorXd& assembly, LoopCompletion& completion,
                 LoopKinematics& kinematics, std::vector<LoopForces>& forces);

}  // namespace virtual_work_dynamics
