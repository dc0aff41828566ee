#pragma once

#include <string>
#include <vector>

#include "omissions.h"

namespace virtual_work_dynamics {

/// A comparison of the numbers that two plans have in common.
struct Sameness {
  std::size_t numbers = 0;        ///< how many were compared, in all states together
  bool identical = true;          ///< whether they are equal, except for the sign of zeros
  double largest_difference = 0;  ///< relative to the largest number of the kind in the state
};

/// Random states of the plan's coordinates, the same in every run.
std::vector<Motion> randomStates(const NamedPlan& plan, std::size_t count);

/// Compares an omission's plan with the one that leaves nothing out in `count` random states.
/// Coordinates that only the latter has stand still at zero.
/// @throws Error when a number is not finite, or when the plans have no number in common.
Sameness compare(const Omission& omission, std::size_t count);

}  // namespace virtual_work_dynamics
