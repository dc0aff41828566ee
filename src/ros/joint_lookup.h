#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Index of the generalized coordinate of each joint that has one of its own (not mimic joints),
/// except for the angles of joints that turn freely, which tell no orientation.
inline std::unordered_map<std::string, int> coordinatesByName(const Mechanism& mechanism) {
  std::unordered_map<std::string, int> coordinates;
  int coordinate = 0;
  for (const std::string& name : mechanism.coordinateNames()) {
    coordinates.emplace(name, coordinate++);
  }
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto angle = static_cast<std::size_t>(mechanism.anglesOf(i) + axis);
      coordinates.erase(mechanism.coordinateNames()[angle]);
    }
  }
  return coordinates;
}

}  // namespace virtual_work_dynamics
