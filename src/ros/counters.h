#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "base/run_time_histogram.h"
#include "ros/rejection.h"

namespace virtual_work_dynamics {

/// A count that one thread raises and others read.
class Counter {
 public:
  void add() { value_.store(value() + 1, std::memory_order_relaxed); }
  std::uint64_t value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

/// What the receiving thread has done; any thread may read.
struct Counters {
  Counter joint_states;
  Counter trajectories;
  Counter accepted_joint_states;
  Counter restarts;
  Counter samples;  ///< computed from joint states
  Counter points;   ///< computed of trajectories
  Counter skipped;  ///< samples that nobody listened for
  Counter outputs;  ///< samples and points published
  Counter late;     ///< outputs of joint states
  std::array<Counter, kDropReasonNames.size()> dropped;
  RunTimeHistogram run_times;

  /// Counts and remembers a rejection. Locks: not for messages that are good.
  void drop(DropReason reason, const std::string& text);
  std::uint64_t allDropped() const;
  std::string lastDrop() const;

 private:
  mutable std::mutex last_drop_mutex_;
  std::string last_drop_;
};

}  // namespace virtual_work_dynamics
