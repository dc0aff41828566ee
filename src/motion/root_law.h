#pragma once

#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/motion_law.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// The motion of a root link as a function of time, through the rows of a table: a tableLaw() of
/// its RootCoordinates, so that no attitude is special. Velocities count where linear and angular
/// ones are given, and accelerations where those are, too.
class RootLaw {
 public:
  /// @param table whose first row is at time zero; from one to the next the root turns by less than
  ///   half a turn
  /// @throws MotionError for a table without positions or orientations of the root, and as
  ///   tableLaw().
  explicit RootLaw(const MotionTable& table);

  /// Finds the motion at time t, s. Allocates.
  RootMotion at(double t) const;
  /// Whether accelerations are those of the table, and not only of the curve through its rows.
  bool hasAccelerations() const { return has_accelerations_; }

 private:
  bool has_accelerations_;
  std::unique_ptr<MotionLaw> law_;
};

}  // namespace virtual_work_dynamics
