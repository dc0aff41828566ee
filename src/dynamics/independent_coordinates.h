#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Which coordinates determine those of all others. Where wheels, blades and couplings tie rates
/// alone, positions follow from fewer conditions than rates do, and more of them are independent.
struct IndependentCoordinates {
  const std::vector<bool>& of(std::size_t level) const { return level == 0 ? positions : rates; }

  std::vector<bool> positions;  ///< at least those of the rates
  std::vector<bool> rates;      ///< velocities and accelerations
};

/// Chooses coordinates whose rates determine those of all others at the assembly, given ones first.
/// Allocates.
std::vector<bool> independentCoordinates(const ClosedLoopDynamics& dynamics);

/// Adds to these, given ones first, those whose positions do not follow from theirs; without loops
/// all are independent. Allocates.
/// @param have_positions whether all conditions tie positions, so that nothing is to be added
IndependentCoordinates independentCoordinates(const Mechanism& mechanism,
                                              const std::optional<ClosedLoopDynamics>& dynamics,
                                              bool have_positions);

}  // namespace virtual_work_dynamics
