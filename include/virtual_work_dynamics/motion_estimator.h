#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// How MotionEstimator makes motions from joint states.
struct EstimatorSettings {
  int window = 9;            ///< samples in the least-squares polynomial
  int order = 3;             ///< order of the polynomial; window >= order + 1
  int lag = 4;               ///< motions hold this many samples behind the newest one, < window
  bool use_velocity = true;  ///< whether velocities are fitted too where messages carry them
  double max_gap = 0.25;     ///< s between samples; a longer gap restarts the window
  /// False: motions are the joint states as they come, unwrapped (velocity zero where none is
  /// given), with zero acceleration; window, order and lag have no effect.
  bool estimate = true;
};

/// Positions, velocities and accelerations at an instant from a stream of joint states: a causal
/// least-squares polynomial over the last samples of each joint, with their real stamps. Whole
/// turns that a driver leaves out of positions are put back (TurnCounter). Does not allocate after
/// construction.
class MotionEstimator {
 public:
  /// What push() did with a joint state.
  enum class Verdict {
    kAccepted,
    kEqualStamp,     ///< dropped: a joint already has a sample of this stamp
    kRestartedBack,  ///< accepted as the first of a new window, as time went backwards
    kRestartedGap    ///< accepted as the first of a new window, after a gap longer than max_gap
  };

  /// @throws MotionError when the settings contradict each other, naming the value.
  MotionEstimator(const Mechanism& mechanism, const EstimatorSettings& settings);
  ~MotionEstimator();

  /// Takes a joint state of some or all generalized coordinates.
  /// @param stamp_ns time of the state, ns.
  /// @param coordinates indices of the generalized coordinates, `count` of them, each once.
  /// @param q positions, rad or m.   @param qd velocities, rad/s or m/s; null: not given.
  Verdict push(std::int64_t stamp_ns, const int* coordinates, const double* q, const double* qd,
               int count);

  /// The longest time from the previous sample of a joint in the latest push() to that push(), ns;
  /// meaningless when it went backwards.
  std::int64_t latestGap() const;

  /// Waits for and evaluates only the coordinates with a true entry from now on; samples of the
  /// others are still kept. Without this call all are waited for.
  /// @param coordinates one entry for each generalized coordinate.
  /// @throws MotionError for another number of entries.
  void waitFor(const std::vector<bool>& coordinates);

  /// True once every coordinate waited for has a full window, was refreshed since the last
  /// evaluate() or skip(), and has samples as early as the common instant.
  bool ready() const;

  /// Computes the motion at the common instant. Each coordinate has a sample `lag` samples behind
  /// its newest; the instant is the earliest stamp of these samples (but not before the last 512
  /// samples of any coordinate). A coordinate that came more often than the others is fitted around
  /// that instant, not around its own newest samples. Every coordinate then has to be refreshed
  /// before ready() is true again.
  /// @param motion has one entry for each generalized coordinate; entries of coordinates that are
  ///   not waited for keep their values. Positions are unwrapped from the first sample after a
  ///   restart on.
  /// @returns the instant, ns.
  /// @throws MotionError unless ready(), or for a motion of another size.
  std::int64_t evaluate(Motion& motion);

  /// Consumes the samples as evaluate() does, without computing anything: for when nobody listens.
  void skip();

  /// Forgets all samples.
  void reset();

  /// Gives the latest position of a coordinate, unwrapped, rad or m, also after reset(). Returns
  /// false when the coordinate has never been seen.
  bool latestPosition(int coordinate, double& q) const;

  /// True when the coordinate has not been refreshed since the last evaluate() or skip().
  bool stale(int coordinate) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
