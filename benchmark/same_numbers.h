#pragma once

#include <string>
#include <vector>

#include "omissions.h"

namespace virtual_work_dynamics {

/// What the numbers have to do with each other that two plans have in common.
struct Sameness {
  std::size_t numbers = 0;        ///< compared, in all states together
  bool identical = true;          ///< but for the sign of zeros
  double largest_difference = 0;  ///< of a number over the largest of its kind in the state
};

/// Random states of the plan's coordinates, the same in every run.
std::vector<Motion> randomStates(const NamedPlan& plan, std::size_t count);

/// Compares an omission's plan with the one that leaves nothing out, `count` random states.
/// Coordinates that only the latter has stand still at zero.
/// @throws Error when a number is not finite or there is none in common.
Sameness compare(const Omission& omission, std::size_t count);

}  // namespace virtual_work_dynamics
