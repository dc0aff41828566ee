#pragma once

#include <vector>

#include "contenders/contender.h"

namespace virtual_work_dynamics {

// These functions append their contenders for a scene, which is a tree unless the comment says
// otherwise; a peer that cannot compute it appends nothing.

/// Appends InverseDynamics, one sample after another.
void offerOwnSingle(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Appends the recursion in long double, one sample after another.
void offerOwnLongDouble(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Appends blocks of samples by BlockInverseDynamics: in each layout, by each build that this
/// machine runs, by one thread and by two.
void offerOwnBlocks(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Appends code that is generated for the scene and compiled now, one sample after another and in
/// blocks, for robots of up to 60 joints.
void offerGenerated(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Appends Lagrange's equations, in double and in long double, for robots of up to 100 joints.
void offerOwnLagrange(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Appends KDL's solvers: ChainIdSolver_RNE for the chain that kdl_parser would build and for the
/// chain with fixed joints merged, and TreeIdSolver_RNE.
void offerKdl(const BenchmarkScene& scene, std::vector<Offer>& offers);
#ifdef VWD_WITH_MUJOCO
void offerMujoco(const BenchmarkScene& scene, std::vector<Offer>& offers);
#endif
#ifdef VWD_WITH_DART
void offerDart(const BenchmarkScene& scene, std::vector<Offer>& offers);
#endif

/// Appends Dynamics for closed loops, with the whole motion given, or only that of the actuated
/// joints.
void offerOwnLoops(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Appends efforts and completions by a user's own code for pins, balls and springs of up to 30
/// joints, see DenseLinkage.
void offerDenseLoops(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Appends one linear system of all bodies, and Lagrange's equations with multipliers, for closed
/// loops of up to 30 joints.
void offerLoopFormalisms(const BenchmarkScene& scene, std::vector<Offer>& offers);

}  // namespace virtual_work_dynamics
