#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros/joint_state_conversion.h"

namespace virtual_work_dynamics {

/// The efforts that joint states say were measured, as long as somebody uses them, and the latest
/// joint state as it came. Serves one thread but for users, which come and go in any. Does not
/// allocate after construction.
class EffortMeasurements {
 public:
  /// Measurements of a joint that are kept at most.
  static constexpr std::size_t kMost = 4096;
  /// Stands for the stamp of what has not come.
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

  /// @param max_gap s, between two measurements that are read on a straight line
  EffortMeasurements(std::vector<std::string> coordinates, double max_gap);

  /// Somebody who uses the measurements while it lives.
  class User {
   public:
    /// @param observes whether no joint may be without position and velocity, see news()
    explicit User(std::shared_ptr<EffortMeasurements> used, bool observes = false)
        : used_(std::move(used)), observes_(observes) {
      ++used_->users_;
      if (observes_) ++used_->observers_;
    }
    ~User() {
      if (observes_) --used_->observers_;
      --used_->users_;
    }
    User(const User&) = delete;
    const EffortMeasurements& operator*() const { return *used_; }
    const EffortMeasurements* operator->() const { return used_.get(); }

   private:
    std::shared_ptr<EffortMeasurements> used_;
    const bool observes_;
  };

  /// Time went back: forgets all that was measured.
  void restart();
  /// Takes a joint state if there are users; of each joint, only what is newer than before.
  void take(const JointSample& sample);
  /// Gives a coordinate that may never come a position to rest at until it does, rad or m.
  void setRest(int coordinate, double position);
  /// Says in a line, once of each, which joints come without efforts, and which have no position or
  /// no velocity although somebody observes. Allocates where it says something.
  std::optional<std::string> news();

  /// The effort at an instant, between two measurements on a straight line; NaN where it is not
  /// known, as beyond the newest one.
  double at(std::size_t coordinate, std::int64_t stamp_ns) const;

  /// The newest positions, velocities and efforts by coordinate, NaN where they are not known.
  struct Latest {
    std::int64_t stamp_ns = kNever;       ///< of the newest joint state
    std::vector<std::int64_t> stamps_ns;  ///< of each coordinate
    std::vector<double> q, qd, effort;
  };
  const Latest& latest() const { return latest_; }
  std::size_t coordinates() const { return rings_.size(); }

 private:
  struct Measured {
    std::int64_t stamp_ns;
    double effort;
  };
  struct Ring {
    std::vector<Measured> values;
    std::size_t first = 0, size = 0;
    bool seen = false;  // with or without an effort
    const Measured& at(std::size_t i) const { return values[(first + i) % kMost]; }
  };

  void clearLatest();
  std::optional<std::string> newsOfEfforts();
  std::optional<std::string> newsOfMotions();

  const std::vector<std::string> names_;
  const std::int64_t max_gap_ns_;
  std::atomic<int> users_{0}, observers_{0};
  std::vector<double> rest_;  // positions, NaN: does not rest
  std::vector<Ring> rings_;
  Latest latest_;
  std::size_t taken_ = 0;  // joint states since time went back
  bool efforts_told_ = false, motions_told_ = false;
};

}  // namespace virtual_work_dynamics
