#pragma once

#include <cstddef>
#include <vector>

namespace virtual_work_dynamics {

/// What a motion gives of a mechanism with closed loops; the closures determine the rest.
///
/// Besides generalized coordinates, the free axes of closures and the poses of links count as
/// coordinates. Their values are the driven numbers: first one for each free axis, as in
/// LoopResults::actuated_positions, rad or m; then kPoseNumbers for each link: x, y, z of its
/// frame's origin, m, and the quaternion x, y, z, w of its axes, both in the root link. A
/// quaternion need not be of length one, so that its numbers may be interpolated and smoothed like
/// any others.
struct Given {
  static constexpr std::size_t kPoseNumbers = 7;

  std::vector<bool> coordinates;      ///< by generalized coordinate
  std::vector<std::size_t> closures;  ///< revolute or prismatic ones, by index in the scene
  std::vector<int> links;             ///< by index in the mechanism; not the root link

  std::size_t drivenNumbers() const { return closures.size() + kPoseNumbers * links.size(); }
};

}  // namespace virtual_work_dynamics
