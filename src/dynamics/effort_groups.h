#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Names of efforts by what delivers them, each in the order of Dynamics::effortNames().
struct EffortGroups {
  explicit EffortGroups(const Dynamics& dynamics);

  std::vector<std::string> actuated;   ///< of actuators
  std::vector<std::string> passive;    ///< of passive coordinates, which are zero
  std::vector<std::string> residuals;  ///< of free motions, which nothing delivers
  std::vector<std::string> couplings;  ///< which couplings deliver
};

}  // namespace virtual_work_dynamics
