#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_csv.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A recorded motion with the lines on which its rows stand.
struct MotionFile {
  std::string path;
  MotionTable table;
  std::vector<std::size_t> lines;

  /// "path: line n", of a row.
  std::string at(std::size_t row) const { return path + ": line " + std::to_string(lines[row]); }
};

/// Reads a motion of all coordinates, and notes on standard error what of it is ignored.
/// @throws FileError
MotionFile readMotion(const std::string& path, const Mechanism& mechanism);

/// The same of the coordinates that `choose` takes of the joints that have a position.
MotionFile readMotion(const std::string& path, const Mechanism& mechanism,
                      const JointChoice& choose);

/// Gives the motion every derivative that it lacks, with a note on standard error: zero in static
/// scenes, else estimated. @throws FileError when times do not allow that.
void completeDerivatives(const Mechanism& mechanism, const Scene& scene, MotionFile& motion);

}  // namespace virtual_work_dynamics
