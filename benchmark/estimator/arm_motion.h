#pragma once

#include <array>
#include <vector>

#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

constexpr int kArmJoints = 6;

/// How the arm moves: from point to point with limited jerk or with limited acceleration, with
/// short rests between the moves; or by sums of slow sines, which are in motion from the start.
enum class MotionKind { kJerkLimited, kTrapezoids, kFourier };

/// A motion of a six-axis arm that is known exactly.
class ArmMotion {
 public:
  /// @param seconds until which there are moves.   @param still whether two joints stand still.
  ArmMotion(MotionKind kind, double seconds, bool still, unsigned seed);

  /// Computes the motion at a time, s; `motion` has kArmJoints coordinates.
  void evaluate(double time, Motion& motion) const;

 private:
  using Angles = std::array<double, kArmJoints>;
  /// A part of a move in which the jerk is constant.
  struct Segment {
    double duration;      // s
    double acceleration;  // at its start, of no unit
    double jerk;          // the same per s
  };
  struct Move {
    double start;  // s
    std::vector<Segment> segments;
    Angles from;  // rad
    Angles by;    // rad
  };
  /// Way, velocity and acceleration along a move, of no unit.
  struct Progress {
    double way = 0;
    double velocity = 0;
    double acceleration = 0;
  };

  static Progress along(const Move& move, double time);
  static std::vector<Segment> jerkLimited(double distance);
  static std::vector<Segment> trapezoid(double distance);
  void evaluateMoves(double time, Motion& motion) const;
  void evaluateSines(double time, Motion& motion) const;

  static constexpr int kSines = 5;

  MotionKind kind_;
  bool still_;
  std::vector<Move> moves_;
  std::array<std::array<double, kSines>, kArmJoints> sines_{};    // rad
  std::array<std::array<double, kSines>, kArmJoints> cosines_{};  // rad
};

}  // namespace virtual_work_dynamics
