#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/noise_settings.h"

namespace virtual_work_dynamics {

/// How completeMotion() estimates.
struct CompletionSettings {
  NoiseSettings noise;
  /// s: each row is estimated from the rows up to this time after it, as MotionEstimator would;
  /// infinite: from all rows (zero phase).
  double lag = std::numeric_limits<double>::infinity();
  /// s: nothing is assumed of the motion across longer gaps, unless they are usual.
  double max_gap = 0.25;
  bool covariances = false;  ///< whether MotionTable::covariances is filled in
  /// Whether positions stay as given: with closed loops smoothed ones would not close them, and a
  /// row that cannot be closed would take others with it.
  bool keep_positions = false;
  /// Whether other columns than those of generalized coordinates are estimated, too. Their
  /// positions are taken as they are.
  bool other_columns = false;
  /// Told now and then how many of how many steps are done; may be empty.
  std::function<void(std::size_t done, std::size_t total)> progress;
};

/// What completeMotion() found and did.
struct CompletionReport {
  bool estimated = false;   ///< false: nothing was missing
  bool even_clock = false;  ///< times were taken as those of an even clock
  std::size_t gaps = 0;     ///< longer than max_gap
  /// Rows near a gap, a jump or an end whose estimates, with rows on one side only, are less exact:
  /// by more than twice the standard deviation elsewhere, and by more than 1e-4 of the motion's
  /// rms; where most rows are near one of these, by more than 0.2 % of that.
  std::size_t one_sided = 0;
  std::vector<bool> one_sided_rows{};    ///< which rows these are; empty: nothing was missing
  std::vector<StreamQuality> qualities;  ///< of each joint of the table
  std::vector<bool> still;               ///< whether the joint does not move at all
  /// Rows of each joint at which its position jumps, as no motion does: nothing is assumed across.
  std::vector<std::vector<std::size_t>> jumps;
  /// Rows of each joint whose position stands alone, far from those before and after: left out.
  std::vector<std::vector<std::size_t>> left_out;
};

/// Estimates the velocities or accelerations that a recorded motion lacks by a smoother for each
/// joint: a Kalman filter forward and the adjoint of its innovations back (Bryson and Frazier
/// 1963), in which a derivative of the motion (third to sixth, by likelihood) is white noise. The
/// noises of positions, velocities and stamps and the density of the motion are those under which
/// the rows are most likely (Schweppe 1965). Uneven stamps are taken as those of an even clock if
/// that makes the positions likelier. Where accelerations are missing, positions and velocities
/// become the smoothed ones as well; accelerations that are given stay, with the positions.
/// Velocities that contradict the positions are not used. Positions become the unwrapped ones in
/// any case (unwrapPositions()). Allocates.
/// @param motion a table whose columns are generalized coordinates of `mechanism`.
/// @param report receives what was found when not null.
/// @throws MotionError for a joint that is not a generalized coordinate, unless the settings allow
///   that, shapes that disagree, too
///   few rows (accelerations need three, velocities two), or times that do not increase, naming the
///   row counted from 1.
MotionTable completeMotion(const Mechanism& mechanism, MotionTable motion,
                           const CompletionSettings& settings = {},
                           CompletionReport* report = nullptr);

/// Index of the first time that is not later than the one before it; times.size() when all times
/// increase.
std::size_t firstTimeThatDoesNotIncrease(const std::vector<double>& times);

}  // namespace virtual_work_dynamics
