#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "motion/far_positions.h"
#include "motion/shown_noise.h"
#include "motion/stream_learner.h"
#include "motion/stream_model.h"
#include "motion/stream_surprise.h"
#include "motion/track_samples.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {

/// The latest samples of one coordinate with the states of its filter: takes samples as they come,
/// also late ones, and gives the motion at instants that they surround (fixed lag). The model of
/// the filter is StreamLearner's. Does not allocate after construction.
class CoordinateTrack {
 public:
  enum class Verdict {
    kTaken,
    kInserted,    ///< it came late, and took its place among the others
    kTooLate,     ///< dropped: its place is no longer kept
    kEqualStamp,  ///< dropped: there is a sample of this stamp
    kAfterGap     ///< taken as the first of a new stretch
  };

  /// Fewest samples of a stretch that derivatives can be estimated from.
  static constexpr int kFewest = 4;

  CoordinateTrack(const Joint& joint, const EstimatorSettings& settings);

  /// @param qd NaN: not given.
  Verdict push(std::int64_t stamp, double q, double qd);
  void clear();

  bool empty() const { return samples_.size() == 0; }
  std::int64_t newest() const { return samples_[0].stamp; }
  double newestPosition() const { return samples_[0].q; }
  double newestVelocity() const { return samples_[0].qd; }
  /// Usual time between samples, s; infinite before there are two.
  double interval() const { return samples_.interval(); }
  /// Samples since the latest gap, at most the number that are kept.
  int stretch() const { return samples_.stretch(); }
  /// From which stamp on there is nothing to evaluate yet, as it is open what the newest samples
  /// are; the largest number: there is none.
  std::int64_t doubtStart() const {
    if (far_ == 0) return std::numeric_limits<std::int64_t>::max();
    return stretch() - far_ < kFewest ? stretch_start_ : samples_[far_ - 1].stamp;
  }
  /// First stamp of the latest stretch.
  std::int64_t stretchStart() const { return stretch_start_; }

  /// Finds the earliest sample later than `after` that is at least `lag` ns older than the newest.
  bool nextInstant(std::int64_t after, std::int64_t lag, std::int64_t& instant) const {
    return samples_.nextInstant(after, lag, instant);
  }

  /// Estimates the motion at an instant: position (unwrapped), velocity, acceleration, and their
  /// covariance if not null. To be called with samples only.
  Eigen::Vector3d evaluate(std::int64_t instant, Eigen::Matrix3d* covariance) const;
  /// Whether the motion at an instant can be estimated: the sample before it is at most `longest`
  /// ns old, or followed by others without a gap, and its stretch has enough of them.
  bool covers(std::int64_t instant, std::int64_t longest) const {
    return samples_.surround(instant, longest, kFewest);
  }
  /// The newest position, unwrapped.
  double unwrappedPosition() const { return samples_[0].unwrapped(); }
  /// Position of the latest sample up to an instant, unwrapped.
  double positionBefore(std::int64_t instant) const {
    return samples_[samples_.ageAt(instant)].unwrapped();
  }

  /// What the samples were found to be.
  StreamQuality quality() const;
  /// Whether the noise of the samples is known: given, learnt or shown, or as they do not move.
  bool knowsNoise() const {
    return !moves_ || !learner_.finds() || learner_.learnt() || noise_.deviation() > 0;
  }
  /// Whether the positions jump to and fro, as those of two publishers that contradict each other.
  bool contradictory() const { return jumps_ >= kManyJumps; }

 private:
  static constexpr int kOrder = TrackSample::kOrder;
  static constexpr int kManyJumps = 20;

  void begin(TrackSample& entry);
  void beginAnew(int samples);
  void take(TrackSample& now);
  bool newestIsFar() const;
  void takeInDoubt();
  FarFinding judgeNewest() const;
  void leaveOut(int samples);
  int startingCount() const;
  bool startIsStale() const;
  void restart(int samples);
  void follow(const TrackSample& before, TrackSample& entry);
  Verdict insert(std::int64_t stamp, double q, double qd);
  void noteNoise(int age);
  void noteJump();
  void adapt(TrackSample& now);
  double usualInterval() const;
  void startStretch(std::int64_t stamp);
  void recordSettled();
  void useLearnt();
  const StreamModel& model() const { return learner_.model(); }

  TurnCounter turn_counter_;
  const double lag_;  // s
  const std::int64_t max_gap_;
  TrackSamples samples_;
  std::int64_t stretch_start_ = 0;
  int jumps_ = 0;  // to and fro
  int far_ = 0;    // newest samples of which it is open what they are
  int begun_ = 0;  // motions that began with a jump
  int left_out_ = 0;
  bool moves_ = false;  // whether a position was another than that before

  ShownNoise noise_;
  StreamSurprise surprise_;
  StreamLearner learner_;
  double started_variance_ = 0;  // of positions, when the filter was last started
};

}  // namespace virtual_work_dynamics
