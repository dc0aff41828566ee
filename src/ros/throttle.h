#pragma once

#include <chrono>

namespace virtual_work_dynamics {

/// Lets a line of the log through once a second, or in another period, by the steady clock: ROS
/// time stands still under use_sim_time until /clock comes, and a looping bag turns it back.
class Throttle {
 public:
  Throttle() = default;
  explicit Throttle(std::chrono::seconds period) : period_(period) {}

  /// Whether the line may be logged now.
  bool open() {
    const auto now = std::chrono::steady_clock::now();
    if (used_ && now - latest_ < period_) return false;
    used_ = true;
    latest_ = now;
    return true;
  }

 private:
  std::chrono::seconds period_{1};
  bool used_ = false;
  std::chrono::steady_clock::time_point latest_;
};

}  // namespace virtual_work_dynamics
