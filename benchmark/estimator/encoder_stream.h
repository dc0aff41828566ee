#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "estimator/arm_motion.h"

namespace virtual_work_dynamics {

/// Velocities that come with the positions: none; those of the motion with little noise; or wrong.
enum class VelocityKind { kNone, kGood, kZero, kDegrees, kTooLarge, kNoisy };

/// How joint states of the arm are sampled and read.
struct StreamSpec {
  std::string group = "grid";  ///< which comparison it belongs to
  int rate = 1000;             ///< Hz
  double quantum = 1e-4;       ///< rad, step of the encoders
  VelocityKind velocity = VelocityKind::kNone;
  double jitter = 0;  ///< s, standard deviation by which stamps err
  MotionKind motion = MotionKind::kJerkLimited;
  double uneven = 0;   ///< of an interval: width in which samples are taken, which stamps tell
  double white = 0;    ///< quanta, standard deviation of a reading before it is rounded
  double dropped = 0;  ///< share of the rows that are missing
  bool still = false;  ///< whether two joints stand still
  double seconds = 8;

  bool hasVelocities() const { return velocity != VelocityKind::kNone; }
  /// Standard deviation of a position, rad.
  double positionNoise() const;
  /// Standard deviation of a good velocity, rad/s.
  double velocityNoise() const { return 20 * quantum; }
  /// The same stream sampled evenly with true stamps and all rows.
  StreamSpec even() const;
  /// For messages and tables.
  std::string name() const;
};

/// What a stream sends, with the motion that it was read from.
struct EncoderRecording {
  StreamSpec spec;
  ArmMotion motion;
  std::vector<double> stamps;  ///< s
  std::vector<double> times;   ///< s, at which rows were really read
  Eigen::MatrixXd positions;   ///< rows x joints, rad
  Eigen::MatrixXd velocities;  ///< rows x joints, rad/s; 0 x 0: none

  std::size_t rows() const { return times.size(); }
};

/// Records a stream. Noise is the same each time.
EncoderRecording record(const StreamSpec& spec);

/// `count` rows spread evenly over those read between two times, s.
std::vector<std::size_t> rowsBetween(const EncoderRecording& recording, double from, double to,
                                     std::size_t count);

}  // namespace virtual_work_dynamics
