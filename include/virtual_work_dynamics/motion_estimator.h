#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/noise_settings.h"

namespace virtual_work_dynamics {

/// How MotionEstimator makes motions from joint states.
struct EstimatorSettings {
  double lag = 0.05;      ///< s that motions are behind the newest sample; 0 … 1
  double max_gap = 0.25;  ///< s between samples, across which nothing is assumed of the motion
  double hold_after =
      0.25;             ///< s without a sample after which a joint is held at its last position
  NoiseSettings noise;  ///< what is known beforehand of the samples
  /// False: motions are the joint states as they come, unwrapped (velocity zero where none is
  /// given) with zero acceleration; neither lag nor noise has an effect.
  bool estimate = true;
};

/// Positions, velocities and accelerations at an instant from a stream of joint states, with their
/// covariance: for each joint a Kalman filter and the adjoint of the innovations after the instant
/// (Bryson and Frazier 1963), in which the fourth derivative of the motion is white noise. The
/// noises of positions, velocities and stamps and the density of the motion are learnt from the
/// latest seconds of each joint: those under which they are most likely (Schweppe 1965).
/// Velocities are used once they have been seen to agree with the positions. Whole turns
/// that a driver leaves out of positions are put back (TurnCounter). Does not allocate after
/// construction.
class MotionEstimator {
 public:
  /// What push() did with a joint state.
  enum class Verdict {
    kAccepted,
    kReordered,     ///< accepted: it came late, and took its place among the others
    kTooLate,       ///< dropped: it came late, and its place is no longer kept
    kEqualStamp,    ///< dropped: all of its joints have a sample of this stamp
    kAfterGap,      ///< accepted; a joint had a gap longer than max_gap
    kRestartedBack  ///< accepted as the first one, as time went far back
  };

  /// @param lengths how many lengths joint states have besides the generalized coordinates, m. They
  ///   are what coordinates are here, and their indices go on behind those.
  /// @throws MotionError for a setting out of range, naming the value.
  MotionEstimator(const Mechanism& mechanism, const EstimatorSettings& settings,
                  std::size_t lengths = 0);
  ~MotionEstimator();

  /// Takes a joint state of some or all generalized coordinates.
  /// @param stamp_ns time of the state, ns.
  /// @param coordinates indices of the generalized coordinates, `count` of them, each once.
  /// @param q positions, rad or m.
  /// @param qd velocities, rad/s or m/s, NaN where one is not known; null: not given.
  Verdict push(std::int64_t stamp_ns, const int* coordinates, const double* q, const double* qd,
               int count);

  /// The longest time from the previous sample of a joint in the latest push() to that push(), ns.
  std::int64_t latestGap() const;
  /// The coordinate that it was the gap of.
  int latestGapCoordinate() const;

  /// Waits for and evaluates only the coordinates with a true entry from now on; samples of the
  /// others are still kept. Without this call all are waited for.
  /// @param coordinates one entry for each generalized coordinate and length.
  /// @throws MotionError for another number of entries.
  void waitFor(const std::vector<bool>& coordinates);

  /// Gives a coordinate that may never come a position to rest at until it does, rad or m.
  void setRest(int coordinate, double position);

  /// True when evaluate() can give a motion: every coordinate waited for has been seen or rests,
  /// and the fastest of them has a sample that no motion was given for yet and that is `lag` older
  /// than its newest. Several may be due after one push().
  bool ready() const;

  /// Estimates the motion at the next instant, the stamp of a sample of the fastest coordinate. The
  /// others are evaluated at this instant by their own samples; one without a sample for longer
  /// than hold_after before it is held at its last position.
  /// @param motion has one entry for each generalized coordinate; entries of coordinates that are
  ///   not waited for keep their values. Positions are unwrapped from the first sample after
  ///   a restart on.
  /// @param covariance receives the covariances when not null; it has one entry for each
  ///   coordinate. That of a coordinate that is held or rests is zero.
  /// @param lengths receives those, and must have an entry for each; null: there are none.
  /// @returns the instant, ns.
  /// @throws MotionError unless ready(), or for a motion or covariance of another size.
  std::int64_t evaluate(Motion& motion, MotionCovariance* covariance = nullptr,
                        Motion* lengths = nullptr);

  /// Passes over all motions that are due, without computing anything: for when nobody listens.
  void skip();

  /// Forgets all samples.
  void reset();

  /// Gives the latest position of a coordinate, unwrapped, rad or m, also after reset(). Returns
  /// false when the coordinate has never been seen.
  bool latestPosition(int coordinate, double& q) const;

  /// Whether the coordinate was held in the latest motion, for lack of samples.
  bool held(int coordinate) const;
  /// Whether a coordinate was held that came before.
  bool anyHeld() const;
  /// Whether the noise of all coordinates waited for is known, be it from the settings, from what
  /// their samples show, or as they have not moved. Covariances before say little.
  bool knowsNoise() const;
  /// s from the latest sample of the coordinate to the latest one of any; infinite: none.
  double age(int coordinate) const;
  /// What the samples of the coordinate were found to be.
  StreamQuality quality(int coordinate) const;
  /// Whether the positions of the coordinate jump to and fro, as those of two publishers that
  /// contradict each other.
  bool contradictory(int coordinate) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
