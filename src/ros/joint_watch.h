#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// Remembers when the joint states last showed each coordinate. The reading thread tells the time,
/// so that the receiving thread need not look at a clock.
class JointWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// A joint that was not shown for longer than this is missing.
  static constexpr std::chrono::seconds kPatience{5};

  /// @param needed which of the joints are waited for.
  /// @param following which are not waited for where all others are, unless they were seen.
  JointWatch(std::vector<std::string> joints, std::vector<bool> needed,
             std::vector<bool> following);

  /// Takes note of `count` coordinates that a joint state shows; called by the receiving thread.
  void saw(const int* coordinates, int count);
  /// Makes all joints be waited for from now on; called by the receiving thread.
  void needAll() { all_needed_ = true; }

  /// Tells the time; called by the reading thread.
  void setTime(Clock::time_point now);
  /// The joints waited for that were never seen.
  std::vector<std::string> neverSeen() const;
  /// Says, a line each, which joints are given in vain, and which are waited for.
  std::vector<std::string> doubts() const;
  /// The joints waited for that were never seen, or not for kPatience.
  std::vector<std::string> missing() const;

 private:
  static constexpr std::int64_t kNever = -1;

  std::vector<std::string> notNeeded(bool seen) const;
  bool isNeeded(std::size_t i) const;

  std::vector<std::string> joints_;
  const std::vector<bool> needed_, following_;
  std::atomic<bool> all_needed_{false};
  const Clock::time_point start_;
  std::atomic<std::int64_t> now_{0};  // s since start
  std::vector<std::atomic<std::int64_t>> seen_;
};

}  // namespace virtual_work_dynamics
