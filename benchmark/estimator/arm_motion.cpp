#include "estimator/arm_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace virtual_work_dynamics {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kVelocity = 1.5;           // rad/s, of the joint that has the longest way
constexpr double kAcceleration = 6;         // rad/s^2
constexpr double kJerk = 60;                // rad/s^3
constexpr double kFarthest = 1.5;           // rad from the middle
constexpr double kFirstRest = 0.3;          // s
constexpr double kBaseFrequency = 0.1;      // Hz, of the sines
constexpr double kSineAmplitude = 0.4;      // rad, of the slowest sine at most
constexpr int kStillJoints[] = {2, 4};      // of motions in which some stand still
constexpr double kStillAt[] = {0.3, -0.7};  // rad

}  // namespace

ArmMotion::ArmMotion(MotionKind kind, double seconds, bool still, unsigned seed)
    : kind_(kind), still_(still) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  if (kind == MotionKind::kFourier) {
    for (std::size_t j = 0; j < kArmJoints; ++j)
      for (std::size_t i = 0; i < kSines; ++i) {
        const double most = kSineAmplitude / static_cast<double>(i + 1);
        sines_[j][i] = most * uniform(random);
        cosines_[j][i] = most * uniform(random);
      }
    return;
  }
  Angles at;
  for (double& angle : at) angle = uniform(random);
  for (double time = kFirstRest; time < seconds;) {
    Move move;
    move.start = time;
    move.from = at;
    double distance = 0;
    for (std::size_t j = 0; j < kArmJoints; ++j) {
      const double target = kFarthest * uniform(random);
      move.by[j] = target - at[j];
      distance = std::max(distance, std::abs(move.by[j]));
      at[j] = target;
    }
    move.segments = kind == MotionKind::kTrapezoids ? trapezoid(distance) : jerkLimited(distance);
    for (const Segment& segment : move.segments) time += segment.duration;
    time += 0.25 + 0.15 * uniform(random);  // a rest
    moves_.push_back(move);
  }
}

/// The fastest move over a distance, rad, within the limits of velocity, acceleration and jerk.
std::vector<ArmMotion::Segment> ArmMotion::jerkLimited(double distance) {
  double rise = kAcceleration / kJerk;
  double hold = kVelocity / kAcceleration - rise;
  double cruise = 0;
  // Speeding up and slowing down again take a way of kJerk rise (hold + rise) (hold + 2 rise).
  const double way = kJerk * rise * (hold + rise) * (hold + 2 * rise);
  if (distance > way) {
    cruise = (distance - way) / kVelocity;
  } else if (distance > 2 * kJerk * rise * rise * rise) {
    hold = 0.5 * (std::sqrt(rise * rise + 4 * distance / kAcceleration) - 3 * rise);
  } else {
    hold = 0;
    rise = std::cbrt(distance / (2 * kJerk));
  }
  const double a = kJerk * rise;
  return {{rise, 0, kJerk},  {hold, a, 0},  {rise, a, -kJerk}, {cruise, 0, 0},
          {rise, 0, -kJerk}, {hold, -a, 0}, {rise, -a, kJerk}};
}

std::vector<ArmMotion::Segment> ArmMotion::trapezoid(double distance) {
  const double ramp = std::min(kVelocity / kAcceleration, std::sqrt(distance / kAcceleration));
  const double cruise = distance / (kAcceleration * ramp) - ramp;
  return {{ramp, kAcceleration, 0}, {cruise, 0, 0}, {ramp, -kAcceleration, 0}};
}

ArmMotion::Progress ArmMotion::along(const Move& move, double time) {
  Progress progress;
  for (const Segment& segment : move.segments) {
    const double t = std::min(time, segment.duration);
    const double a = segment.acceleration;
    progress.way += t * (progress.velocity + t * (a / 2 + t * segment.jerk / 6));
    progress.velocity += t * (a + t * segment.jerk / 2);
    progress.acceleration = a + t * segment.jerk;
    time -= t;
    if (time <= 0) return progress;
  }
  progress.velocity = 0;
  progress.acceleration = 0;
  return progress;
}

void ArmMotion::evaluate(double time, Motion& motion) const {
  if (kind_ == MotionKind::kFourier) {
    evaluateSines(time, motion);
  } else {
    evaluateMoves(time, motion);
  }
  if (!still_) return;
  for (std::size_t i = 0; i < 2; ++i) {
    motion.q[kStillJoints[i]] = kStillAt[i];
    motion.qd[kStillJoints[i]] = motion.qdd[kStillJoints[i]] = 0;
  }
}

void ArmMotion::evaluateMoves(double time, Motion& motion) const {
  std::size_t at = 0;
  while (at + 1 < moves_.size() && moves_[at + 1].start <= time) ++at;
  const Move& move = moves_[at];
  const Progress now = time > move.start ? along(move, time - move.start) : Progress();
  const double whole = along(move, HUGE_VAL).way;
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    motion.q[joint] = move.from[j] + move.by[j] * now.way / whole;
    motion.qd[joint] = move.by[j] * now.velocity / whole;
    motion.qdd[joint] = move.by[j] * now.acceleration / whole;
  }
}

void ArmMotion::evaluateSines(double time, Motion& motion) const {
  motion.q.setZero();
  motion.qd.setZero();
  motion.qdd.setZero();
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i < kSines; ++i) {
      const double w = kTwoPi * kBaseFrequency * static_cast<double>(i + 1);
      const double sine = std::sin(w * time);
      const double cosine = std::cos(w * time);
      motion.q[joint] += sines_[j][i] * sine + cosines_[j][i] * cosine;
      motion.qd[joint] += w * (sines_[j][i] * cosine - cosines_[j][i] * sine);
      motion.qdd[joint] -= w * w * (sines_[j][i] * sine + cosines_[j][i] * cosine);
    }
  }
}

}  // namespace virtual_work_dynamics
