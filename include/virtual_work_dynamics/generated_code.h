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
struct GeneratedCode {
  std::string header;  ///< contents of the header, NAME.h
  std::string source;  ///< contents of the source, NAME.c, which includes it
  std::size_t multiplications = 0, additions = 0;  ///< of a sample, fused ones as one of both
  std::size_t fused = 0;                           ///< pairs of them that are fused
  std::size_t sines_and_cosines = 0;
  std::size_t functions = 0;  ///< among which the operations are divided
};

/// Generates the code of a mechanism, a scene and a request.
/// @throws SceneError as InverseDynamics does, and when the scene needsClosedLoops(), of which it
///   names the reason; Error when the name is not an identifier.
GeneratedCode generateCode(const Mechanism& mechanism, const Scene& scene, const Request& request,
                           const GeneratedCodeOptions& options = {});

}  // namespace virtual_work_dynamics
