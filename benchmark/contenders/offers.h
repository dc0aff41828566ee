#pragma once

#include <vector>

#include "contenders/contender.h"

namespace virtual_work_dynamics {

// Each appends what it has for a scene, a tree unless named otherwise; a peer that cannot compute
// it appends nothing.

/// One sample after another by InverseDynamics.
void offerOwnSingle(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// The same recursion on long double.
void offerOwnLongDouble(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Blocks of samples by BlockInverseDynamics: in each layout, by each build that this machine runs,
/// by one thread and by two.
void offerOwnBlocks(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Lagrange's equations, in double and in long double; of robots up to 100 joints.
void offerOwnLagrange(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// KDL: ChainIdSolver_RNE as kdl_parser would build the chain, the same with fixed joints merged,
/// and TreeIdSolver_RNE.
void offerKdl(const BenchmarkScene& scene, std::vector<Offer>& offers);
#ifdef VWD_WITH_MUJOCO
void offerMujoco(const BenchmarkScene& scene, std::vector<Offer>& offers);
#endif
#ifdef VWD_WITH_DART
void offerDart(const BenchmarkScene& scene, std::vector<Offer>& offers);
#endif

/// Closed loops by Dynamics: the whole motion given, or only that of the actuated joints.
void offerOwnLoops(const BenchmarkScene& scene, std::vector<Offer>& offers);
/// Closed loops by one linear system of all bodies, and by Lagrange's equations with multipliers;
/// up to 30 joints.
void offerLoopFormalisms(const BenchmarkScene& scene, std::vector<Offer>& offers);

}  // namespace virtual_work_dynamics
