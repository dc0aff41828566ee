#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/following_motors.h"
#include "dynamics/motion_start.h"
#include "offline/driven_rows.h"
#include "offline/motion_file.h"
#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A motion as its file has it: columns of what it gives.
struct RecordedMotion {
  MotionFile file;  ///< columns of coordinates, then of its driven numbers
  /// With joints that rest, and with what has a drive: the closures among it are the last ones.
  Given given;
  std::vector<std::pair<std::string, double>> resting;  ///< joints that the file does not have

  DrivenRows drives;
  FollowingMotors motors;  ///< those that letMotorsFollow() found, then given

  /// Has actuators of transmissions that the file does not give follow from the joints. Returns
  /// false, and changes nothing, where the motion does not give all joints besides them.
  bool letMotorsFollow(const Mechanism& mechanism, const Scene& scene);
  /// Number of columns that are not coordinates.
  std::size_t drivenColumns() const { return given.drivenNumbers() - drives.closures(); }
  /// Number of these that are axes of closures.
  std::size_t closureColumns() const { return given.closures.size() - drives.closures(); }
  MotionStart start(const Mechanism& mechanism) const;
};

/// Reads a motion, adds whole turns that a driver left out, with a note, and says what it gives. In
/// an open chain these are all joints. With closures they are those that have a column
/// `position.<name>`, where a name is that of a joint, of a closure with one free axis, or
/// `pose.<link>.x`, `y`, `z`, `qx`, `qy`, `qz`, `qw`. What has a drive is given, with or without
/// columns.
/// @throws FileError as readMotion(), or for a coordinate without positions; UsageError for a
///   joint of --rest that the robot does not have.
RecordedMotion readRecordedMotion(const MotionSource& source, const Mechanism& mechanism,
                                  const Scene& scene, const RecordingOptions& options);

}  // namespace virtual_work_dynamics
