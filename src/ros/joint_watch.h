#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// When the joint states last showed each coordinate. The reading thread tells the time, so that
/// the other one, which takes in the messages, need not look at a clock.
class JointWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// A joint that was not shown for so long is waited for.
  static constexpr std::chrono::seconds kPatience{5};

  /// @param needed which of them are waited for.
  JointWatch(std::vector<std::string> joints, std::vector<bool> needed);

  /// Receiving thread.
  void saw(const int* coordinates, int count);
  /// From now on all are waited for.
  void needAll() { all_needed_ = true; }

  /// Reading thread.
  void setTime(Clock::time_point now);
  std::vector<std::string> neverSeen() const;
  /// Those not waited for that were ever seen, or that never were.
  std::vector<std::string> notNeeded(bool seen) const;
  /// Those never seen, and those not seen for kPatience.
  std::vector<std::string> missing() const;

 private:
  static constexpr std::int64_t kNever = -1;

  bool isNeeded(std::size_t i) const { return needed_[i] || all_needed_; }

  std::vector<std::string> joints_;
  const std::vector<bool> needed_;
  std::atomic<bool> all_needed_{false};
  const Clock::time_point start_;
  std::atomic<std::int64_t> now_{0};  // s since start
  std::vector<std::atomic<std::int64_t>> seen_;
};

}  // namespace virtual_work_dynamics
