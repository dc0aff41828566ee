#pragma once

#include <chrono>

namespace virtual_work_dynamics {

/// Lets a line of the log through once a second by the steady clock: ROS time stands still under
/// use_sim_time until /clock comes, and a looping bag turns it back.
class Throttle {
 public:
  /// Whether the line may be logged now.
  bool open() {
    const auto now = std::chrono::steady_clock::now();
    if (used_ && now - latest_ < std::chrono::seconds(1)) return false;
    used_ = true;
    latest_ = now;
    return true;
  }

 private:
  bool used_ = false;
  std::chrono::steady_clock::time_point latest_;
};

}  // namespace virtual_work_dynamics
