#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "offline/motion_source.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_csv.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A recorded motion with the place of each of its rows in the file.
struct MotionFile {
  std::string path;
  MotionTable table;
  const char* row_name = "line";        ///< what `lines` count: lines, or messages of a bag
  std::vector<std::size_t> lines;       ///< by row
  std::vector<std::int64_t> stamps_ns;  ///< by row, as recorded; empty: the file has none

  /// By column: standard deviation of positions, rad or m; empty: not estimated.
  std::vector<double> noises;
  std::vector<bool> one_sided;  ///< by row: estimated near an end or a gap; empty: not estimated

  /// Names the place of a row: "line n".
  std::string place(std::size_t row) const {
    return std::string(row_name) + " " + std::to_string(lines[row]);
  }
  /// Names the place of a row in messages: "path: line n".
  std::string at(std::size_t row) const { return path + ": " + place(row); }
};

/// How the derivatives that a recording lacks are estimated, and joints that it lacks.
struct RecordingOptions {
  CompletionSettings completion;
  std::vector<std::pair<std::string, double>> rest;  ///< joints and their positions, rad or m
  /// Stamp at which the time of drives is zero, of files that have stamps; 0: that of the first
  /// row.
  std::int64_t drive_start_ns = 0;
};

/// Reads a motion of all coordinates, and notes on standard error which joints of it are ignored.
/// @throws FileError as readMotionCsv() or readBagMotion(), or for a coordinate without positions.
MotionFile readMotion(const MotionSource& source, const Mechanism& mechanism);

/// Reads a motion of the coordinates that `choose` takes from the joints that have a position, and
/// notes on standard error which joints of it are ignored.
/// @throws FileError as readMotionCsv() or readBagMotion(), or for a coordinate without positions.
MotionFile readMotion(const MotionSource& source, const Mechanism& mechanism,
                      const JointChoice& choose);

/// Fills in the derivatives that the motion lacks: zero in static scenes, otherwise estimated, with
/// a note on standard error. @throws FileError when the times or rows do not allow that.
void completeDerivatives(const Mechanism& mechanism, const Scene& scene,
                         const CompletionSettings& settings, MotionFile& motion);

/// Says on standard error what was found about the joints of an estimated motion.
/// @param joints what the columns of the report are called
void describeEstimate(const Mechanism& mechanism, const MotionFile& motion,
                      const std::vector<std::string>& joints, const CompletionReport& report);

}  // namespace virtual_work_dynamics
