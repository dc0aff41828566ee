#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "loops/follower.h"
#include "offline/loop_sample.h"
#include "offline/motion_file.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// The recorded motion of a mechanism with closed loops. A file that gives all joints is taken as
/// it is and held against the loops; one that gives the actuated joints only is completed.
class LoopMotion {
 public:
  /// Reads the file. Derivatives that it lacks are estimated for actuated joints, and follow from
  /// the closures for passive ones.
  /// @param tolerance of the loops, relative
  /// @throws FileError naming joints that are missing.
  LoopMotion(const std::string& path, const Mechanism& mechanism, const Scene& scene,
             const ClosedLoopDynamics& dynamics, double tolerance);

  const MotionFile& file() const { return file_; }

  /// Whether anything in its rows follows from the closures.
  bool completes() const {
    return positions_follow_ || velocities_follow_ || accelerations_follow_;
  }
  /// The motion of all coordinates in a row. Positions that it lacks are searched for from those of
  /// the row completed before, of the first row from the assembly.
  /// @throws FileError naming line, closure and amount when the loops cannot be closed.
  void complete(std::size_t row, ClosedLoopDynamics& dynamics, Motion& motion);
  /// @throws FileError naming line, closure and amount when the row, computed, violates a loop.
  void check(std::size_t row, const LoopSample& computed) const;

 private:
  void take(std::size_t row, Motion& motion) const;
  [[noreturn]] void throwOpen(std::size_t row, ClosedLoopDynamics& dynamics) const;

  std::vector<std::string> closures_;
  double tolerance_;
  MotionFile file_;
  std::vector<Eigen::Index> coordinates_;  // of the file's columns
  // What of the passive joints follows from the closures.
  bool positions_follow_ = false, velocities_follow_ = false, accelerations_follow_ = false;
  Motion completed_;
  LoopFollower follower_;
};

}  // namespace virtual_work_dynamics
