#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "motion/stream_filter.h"
#include "motion/stream_learner.h"

namespace virtual_work_dynamics {

/// A sample of one coordinate with the state of the filter after it.
struct TrackSample {
  static constexpr int kOrder = StreamLearner::kOrder;

  std::int64_t stamp = 0;  // ns
  double q = 0;            // position as it came, rad or m
  double turns = 0;        // 2 pi turns + q is the unwrapped position
  double qd = 0;           // rad/s or m/s; NaN: not given
  bool first = false;      // of a stretch
  bool counts = true;      // false: what it is is open, or it stands alone and is left out
  bool has_position = false;
  bool has_velocity = false;
  StreamUpdate<kOrder> position;
  StreamUpdate<kOrder> velocity;
  StreamState<kOrder> filtered;  // after this sample, position relative to it

  /// Position, unwrapped.
  double unwrapped() const { return q + kTwoPi * turns; }

 private:
  static constexpr double kTwoPi = 6.283185307179586;
  friend double moved(const TrackSample& from, const TrackSample& to);
};

/// By how much the position changed from one sample to another one, rad or m.
inline double moved(const TrackSample& from, const TrackSample& to) {
  return (to.q - from.q) + TrackSample::kTwoPi * (to.turns - from.turns);
}

/// The latest samples of one coordinate in the order of their stamps, by age: the newest has age 0.
/// A stretch is what came without a gap. Does not allocate after construction.
class TrackSamples {
 public:
  /// @param capacity samples that are kept, a power of two.
  explicit TrackSamples(int capacity) : samples_(static_cast<std::size_t>(capacity)) {}

  void clear();

  int capacity() const { return static_cast<int>(samples_.size()); }
  int size() const { return size_; }
  /// Samples since the latest gap, at most the number that are kept.
  int stretch() const { return stretch_; }
  /// Usual time between samples, s: the mean of the latest intervals; infinite before there are
  /// two samples.
  double interval() const { return interval_; }

  const TrackSample& operator[](int age) const { return samples_[place(age)]; }
  TrackSample& operator[](int age) { return samples_[place(age)]; }

  /// Makes room for a sample that is newer than all others; the oldest one makes way.
  TrackSample& add();
  /// Makes room for a late sample, which then has this age, less than stretch().
  TrackSample& insert(int age);
  /// Takes as many of the newest samples for a stretch.
  void setStretch(int samples) { stretch_ = samples; }
  /// Counts a sample that was added or inserted, whose stamp is known, to the stretch.
  void lengthenStretch();

  /// Age of the latest sample up to an instant; that of the oldest one if all are later.
  int ageAt(std::int64_t instant) const;
  /// Finds the earliest sample later than `after` that is at least `lag` ns older than the newest.
  bool nextInstant(std::int64_t after, std::int64_t lag, std::int64_t& instant) const;
  /// Whether the sample before an instant is at most `longest` ns old, or followed by others
  /// without a gap, and has as many samples as `fewest` in its stretch, or near enough to it.
  bool surround(std::int64_t instant, std::int64_t longest, int fewest) const;

 private:
  std::size_t place(int age) const {
    return static_cast<std::size_t>((newest_ - age) & (capacity() - 1));
  }

  std::vector<TrackSample> samples_;  // a ring
  int newest_ = -1;
  int size_ = 0;
  int stretch_ = 0;
  double interval_ = std::numeric_limits<double>::infinity();
};

}  // namespace virtual_work_dynamics
