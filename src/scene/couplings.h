#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A coupling of the scene between generalized coordinates.
struct ResolvedCoupling {
  struct Term {
    int coordinate;
    double factor;
  };
  std::string name;
  std::vector<Term> terms;  ///< by coordinate, ascending; no factor is zero
  Unit unit = Unit::kRadian;
  bool adopts_offset = false;  ///< the sum stays what it is in the assembly
  bool rate_only = false;
  double offset = 0;    ///< of the coordinates, without the offsets of mimic joints
  double mimicked = 0;  ///< what the offsets of mimic joints add to the sum of the terms
};

/// Resolves the couplings of a scene. A joint that mimics another one counts as that one.
/// @throws SceneError naming a coupling whose name is taken, whose joints do not exist, are fixed,
///   are given twice or turn freely, whose numbers are not finite, that says what mimic joints of
///   the description say already, or that contradicts them or the couplings before it, and by how
///   much.
std::vector<ResolvedCoupling> resolveCouplings(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
