#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/fit_summary.h"
#include "dynamics/following_motors.h"
#include "offline/motion_file.h"
#include "offline/recorded_motion.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_fit.h"
#include "virtual_work_dynamics/passive_joints.h"

namespace virtual_work_dynamics {

/// The recorded motion of all coordinates of a mechanism. A file that gives all joints with their
/// accelerations is taken as it is and checked against the loops, if there are any; where they are
/// estimated, the motion is fitted to the loops. A file that gives only what determines the others
/// is completed by the closures, row by row.
class CompletedMotion {
 public:
  /// Derivatives that the recorded motion lacks are estimated for what it gives, and follow from
  /// the closures for the other joints.
  /// @param scene as startedBy() the motion
  /// @param dynamics of that scene
  /// @param tolerance for relative residuals of the loops
  /// @throws FileError as completeDerivatives().
  CompletedMotion(RecordedMotion recorded, const Mechanism& mechanism, const Scene& scene,
                  const Dynamics& dynamics, double tolerance, const RecordingOptions& options);

  /// The motion of all coordinates; rows that are not completed yet lack what follows from the
  /// closures.
  const MotionFile& file() const { return file_; }

  /// Whether anything in its rows follows from the closures.
  bool completes() const {
    return fit_ || positions_follow_ || velocities_follow_ || accelerations_follow_;
  }
  /// Completes a row of file(). Positions that it lacks are searched for from those of the row
  /// completed before; for the first row, from the assembly.
  /// @throws FileError naming line, closure and amount when the loops cannot be closed.
  void complete(std::size_t row, const Dynamics& dynamics, Dynamics::Workspace& workspace);
  /// Checks that a row closes the loops. Estimated rates need not.
  /// @throws FileError naming line, closure and amount when the computed row violates a loop.
  void check(std::size_t row, const Results& computed) const;
  /// A line on how far rows were fitted to the loops, and on rows that could not be; empty where
  /// none was.
  std::string fitNote(const Mechanism& mechanism) const;

 private:
  void setNoise(const Mechanism& mechanism);
  void fit(std::size_t row);

  std::vector<std::string> closures_;  // and couplings, as messages name them
  double tolerance_;
  MotionFile file_;
  MotionTable driven_;  // numbers that are given besides coordinates
  // Whether the other joints' positions, velocities and accelerations follow from the closures.
  bool positions_follow_ = false, velocities_follow_ = false, accelerations_follow_ = false;
  Motion row_, driven_row_;
  PassiveJoints passive_;
  std::optional<MotionFit> fit_;
  MotionCovariance covariance_;        // of a row that is fitted
  std::vector<std::size_t> measured_;  // coordinates that the file has
  Eigen::VectorXd noise_;              // of single positions, by coordinate
  FollowingMotors motors_;
  FitSummary fitted_;
};

}  // namespace virtual_work_dynamics
