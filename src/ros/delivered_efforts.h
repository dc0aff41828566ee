#pragma once

#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Whether an actuator delivers the effort of each coordinate: neither of a passive joint nor of a
/// motion that nothing drives.
inline std::vector<bool> deliveredEfforts(const Dynamics& dynamics) {
  std::vector<bool> delivered;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dynamics.coordinates()); ++i) {
    delivered.push_back(dynamics.actuated()[i] && !dynamics.residuals()[i]);
  }
  return delivered;
}

}  // namespace virtual_work_dynamics
