#pragma once

#include <string>
#include <unordered_map>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Index of the generalized coordinate of each joint that has one of its own (not mimic joints).
inline std::unordered_map<std::string, int> coordinatesByName(const Mechanism& mechanism) {
  std::unordered_map<std::string, int> coordinates;
  for (const std::string& name : mechanism.coordinateNames()) {
    coordinates.emplace(name, static_cast<int>(coordinates.size()));
  }
  return coordinates;
}

}  // namespace virtual_work_dynamics
