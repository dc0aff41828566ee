#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "base/run_time_histogram.h"
#include "ros/rejection.h"

namespace virtual_work_dynamics {

/// A count that one thread increases and others read.
class Counter {
 public:
  void add() { value_.store(value() + 1, std::memory_order_relaxed); }
  std::uint64_t value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

/// Counts what the receiving thread does, unless something else is said; any thread may read them.
struct Counters {
  Counter joint_states;
  Counter trajectories;
  Counter wrenches;  ///< live ones received
  Counter
      payloads;   ///< messages of payloads and gravity received, counted by the node's own thread
  Counter roots;  ///< messages received that tell how the root link moves
  Counter free_joints;  ///< messages received that tell of joints that turn freely
  Counter accepted_joint_states;
  Counter restarts;             ///< as time went back
  Counter gaps;                 ///< joint states after a gap of one of their joints
  Counter reordered;            ///< joint states that came late and took their place
  Counter foreign;              ///< joint states without a joint of the robot
  Counter velocity_not_finite;  ///< joint states with a velocity that is not finite
  Counter held;                 ///< samples with a joint held at its last position
  Counter wrench_held;          ///< samples with a live wrench held at its last value
  Counter root_restarts;        ///< of the root's poses, as time went back
  Counter root_gaps;            ///< poses of the root after a gap
  Counter root_reordered;       ///< poses of the root that came late and took their place
  Counter root_twist_left;      ///< poses of the root with rates that are not finite
  Counter root_foreseen;        ///< samples with a root's motion behind all that is known of it
  Counter samples;              ///< samples computed from joint states
  Counter points;               ///< points of trajectories computed
  Counter sampled;              ///< samples of trajectories between their points computed
  Counter skipped;              ///< samples not computed because nobody listened
  Counter outputs;              ///< samples and points published
  Counter late;                 ///< samples published later than the threshold
  std::array<Counter, kDropReasonNames.size()> dropped;
  RunTimeHistogram run_times;

  /// Counts and remembers a rejection. Locks a mutex, which good messages must not wait for.
  void drop(DropReason reason, const std::string& text);
  std::uint64_t allDropped() const;
  std::string lastDrop() const;

 private:
  mutable std::mutex last_drop_mutex_;
  std::string last_drop_;
};

}  // namespace virtual_work_dynamics
