#pragma once

#include <chrono>
#include <cstddef>
#include <ostream>

namespace virtual_work_dynamics {

/// A percentage on one line of a terminal. It appears when work takes long and is wiped out in the
/// end, so that whatever is printed next starts on a clean line.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param enabled false: prints nothing, for a stream that is not a terminal.
  /// @param delay time before the line first appears.
  Progress(std::ostream& terminal, bool enabled,
           Clock::duration delay = std::chrono::milliseconds(500))
      : terminal_(terminal), enabled_(enabled), next_(Clock::now() + delay) {}
  ~Progress() {
    if (shown_) terminal_ << "\r     \r" << std::flush;
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::size_t done, std::size_t total) {
    if (!enabled_ || total == 0) return;
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    terminal_ << "\r" << 100 * done / total << " %" << std::flush;
    shown_ = true;
  }

 private:
  std::ostream& terminal_;
  bool enabled_;
  Clock::time_point next_;
  bool shown_ = false;
};

}  // namespace virtual_work_dynamics
