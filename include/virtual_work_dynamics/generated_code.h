#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// How generated code is to look.
struct GeneratedCodeOptions {
  /// With which its names begin: a letter, then letters, digits and underscores.
  std::string name = "robot";
  /// Lines for the comment at its top: where the description comes from, and who made it.
  std::vector<std::string> origin;
  /// Operations of a function at most, so that compilers cope with large robots.
  std::size_t operations_of_function = 4000;
};

/// Source text, as C99 and as C++, that computes one robot in one scene, and nothing else: the
/// operations of InverseDynamics::compute() one after the other, which needs no library but that of
/// C. Its results have the same bits for finite motions, except that a zero may have the other
/// sign; operations are fused as in the builds for AVX2 and AVX-512, or not as in the baseline
/// build, by what it is compiled for.
/// Of a scene with loops, springs between points, couplings or passive joints it computes what
/// ClosedLoopDynamics::compute() does of a motion that gives all joints, with the bits of the
/// builds for AVX2 and AVX-512 where it is compiled with fused operations; its functions return a
/// status: 0 in regular positions, 1 close to singular ones, 2 where the rank is in doubt, or a
/// number is not finite: all results are then zero.
struct GeneratedCode {
  std::string header;  ///< contents of the header, NAME.h
  std::string source;  ///< contents of the source, NAME.c, which includes it
  std::size_t multiplications = 0, additions = 0;  ///< of a sample, fused ones as one of both
  std::size_t fused = 0;                           ///< pairs of them that are fused
  std::size_t sines_and_cosines = 0;
  std::size_t divisions_and_roots = 0;  ///< in scenes with loops
  std::size_t functions = 0;            ///< among which the operations are divided
};

/// Generates the code of a mechanism, a scene and a request.
/// @throws SceneError as InverseDynamics and ClosedLoopDynamics do, and naming what has no straight
///   line of code: what touches or meshes, orientations, poses and twists in scenes with loops,
///   efforts that mechanics does not determine, and other choices of redundant forces than those of
///   least norm; Error when the name is not an identifier.
GeneratedCode generateCode(const Mechanism& mechanism, const Scene& scene, const Request& request,
                           const GeneratedCodeOptions& options = {});

}  // namespace virtual_work_dynamics
