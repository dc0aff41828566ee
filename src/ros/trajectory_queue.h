#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <utility>

#include "ros/trajectory_conversion.h"

namespace virtual_work_dynamics {

/// Trajectories that wait for their points, or their samples, to be played in order at a rate. To
/// be used by one thread.
class TrajectoryQueue {
 public:
  using Clock = std::chrono::steady_clock;
  /// Shortest time between two calls of playDue(), s.
  static constexpr double kTick = 0.001;
  /// Largest number of points that are played at one time: a caller that was held up does not play
  /// everything that it has missed in a burst.
  static constexpr int kMostAtOnce = 20;
  /// Largest rate with kMostAtOnce points in each kTick, points/s.
  static constexpr double kFastest = kMostAtOnce / kTick;

  /// @param rate points/s, above 0 and up to kFastest; it may be 0 when nothing is ever added.
  explicit TrajectoryQueue(double rate)
      : spacing_(rate > 0 ? static_cast<Clock::rep>(1e9 / rate) : 0) {}

  bool empty() const { return trajectories_.empty(); }
  /// Number of points and samples that have not been played.
  std::size_t waiting() const { return waiting_; }

  void add(TrajectoryMotion&& trajectory, Clock::time_point now) {
    if (empty()) next_ = std::max(next_, now);
    waiting_ += trajectory.results();
    trajectories_.push_back(std::move(trajectory));
  }

  /// Calls play(trajectory, place) for every point or sample that is due. One whose call throws
  /// counts as played.
  template <typename Play>
  void playDue(Clock::time_point now, Play play) {
    for (int i = 0; i < kMostAtOnce && waiting_ > 0 && next_ <= now; ++i) {
      next_ += spacing_;
      while (point_ == trajectories_.front().results()) {
        point_ = 0;
        trajectories_.pop_front();
      }
      --waiting_;
      play(trajectories_.front(), point_++);
    }
    if (waiting_ == 0) {
      point_ = 0;
      trajectories_.clear();
    }
    next_ = std::max(next_, now);
  }

 private:
  const std::chrono::nanoseconds spacing_;
  std::deque<TrajectoryMotion> trajectories_;
  std::size_t point_ = 0;  // next point of the first trajectory
  std::size_t waiting_ = 0;
  Clock::time_point next_;
};

}  // namespace virtual_work_dynamics
