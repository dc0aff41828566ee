#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Counts the whole turns that a driver has left out of the positions of a joint, one position
/// after the other. Turns are counted rather than angles summed up, so that nothing accumulates.
/// Does not allocate.
///
/// A continuous joint is taken to go the shorter way: a jump of more than half a turn is a turn
/// that was left out, or several.
///
/// A revolute joint may well go the longer way, and so may the points of a trajectory, which can be
/// far apart. There, a jump is a turn left out only when
///   - the joint would have moved faster than kFastest to make it,
///   - it differs from a whole turn by a quarter at most, and by no more than the joint moves at
///     kFastest until then,
///   - all positions so far lie within one turn, as those of a driver that wraps do, and
///   - the turn does not lead out of the joint's limits.
/// Everything else stays as it came. Prismatic and fixed joints have no turns.
class TurnCounter {
 public:
  /// What the positions are: samples of the motion itself, or points that a motion is to pass.
  enum class Source { kSamples, kPoints };

  /// Fastest motion, rad/s, that a jump by about a turn may still be.
  static constexpr double kFastest = 20;

  /// For a joint that nothing is known of: the rule of a revolute joint without limits.
  TurnCounter() = default;
  explicit TurnCounter(const Joint& joint, Source source = Source::kSamples);

  /// Takes the next position and returns the number of whole turns, an integer, by which it has to
  /// be increased; 0 for the first one.
  /// @param position as it came, rad.
  /// @param since_previous time since the position before, s; not used with the first one.
  double turns(double position, double since_previous);

  /// Takes the next position as the first one.
  void restart();

 private:
  enum class Rule { kNone, kShorterWay, kOnlyIfEvident };

  bool evident(double position, double jump, double since_previous) const;
  bool leavesLimits(double position, double turns) const;

  Rule rule_ = Rule::kOnlyIfEvident;
  double lower_ = 0, upper_ = 0;  // rad; equal: no limits
  bool started_ = false;
  double turns_ = 0;
  double previous_ = 0, lowest_ = 0, highest_ = 0;  // as they came, rad
};

/// Adds the whole turns that a driver has left out to the positions of a table (see TurnCounter).
/// Columns of joints that the mechanism does not have, or that mimic others, stay as they are.
/// @returns the joints whose positions were changed.
/// @throws MotionError when positions, times and joints disagree in number.
std::vector<std::string> unwrapPositions(
    const Mechanism& mechanism, MotionTable& table,
    TurnCounter::Source source = TurnCounter::Source::kSamples);

/// Adds the turns left out to the positions of a table where no description says what the joints
/// are: each counts as a revolute one without limits.
std::vector<std::string> unwrapPositions(MotionTable& table);

}  // namespace virtual_work_dynamics
