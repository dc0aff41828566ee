#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

constexpr int kArmJoints = 6;

/// A motion of the six-axis arm: every joint moves by a sum of sines of equal speed, so that
/// positions, velocities and accelerations are known exactly.
struct ArmMotion {
  static constexpr int kSines = 3;

  const char* name;
  double speed;                            ///< rad/s, amplitude of the velocity of each sine
  std::array<double, kSines> frequencies;  ///< Hz, of the first joint; the others are faster

  /// The highest frequency of any joint, Hz.
  double highestFrequency() const;
  /// Computes the motion at a time in s; `motion` has kArmJoints coordinates.
  void evaluate(double time, Motion& motion) const;
};

/// Reads a joint's position with noise, and rounds it to whole counts.
struct Encoder {
  const char* name;
  double counts;  ///< counts per turn of the encoder's shaft; 0: exact
  double gear;    ///< turns of the encoder's shaft per turn of the joint
  double noise;   ///< standard deviation of a reading before it is rounded, counts
};

/// Velocities that come with the positions: none; the difference to the previous reading over the
/// time since then; or the exact ones.
enum class VelocitySource { kNone, kDifferences, kExact };

/// How positions are stamped: read at even times that the stamps tell; read at uneven times that
/// the stamps tell; or read at even times, but stamped a little wrong.
enum class Stamping { kTrue, kUneven, kWrong };
constexpr double kStampDeviation = 50e-6;  ///< s, standard deviation of kUneven and kWrong

/// A stream of joint states.
struct Stream {
  int rate;  ///< Hz, a divisor of 1e9
  const ArmMotion* motion;
  const Encoder* encoder;
  VelocitySource velocity;
  Stamping stamping;
};

/// A joint state as it is sent.
struct Sample {
  std::int64_t stamp = 0;  ///< ns
  std::array<double, kArmJoints> q{};
  std::array<double, kArmJoints> qd{};
};

/// The true motion and efforts at a stamp.
struct Truth {
  Motion motion{kArmJoints};
  Eigen::VectorXd effort;
};

/// The samples that a stream sends, with the truth.
struct Recording {
  std::vector<Sample> samples;
  std::vector<Truth> truth;      ///< truth at the stamp of each sample
  Eigen::VectorXd effort_range;  ///< largest less smallest effort of each joint, N m
};

/// Records the first `count` samples. Noise is the same each time.
Recording record(const Stream& stream, const InverseDynamics& dynamics, int count);

}  // namespace virtual_work_dynamics
