#pragma once

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <string>
#include <utility>

namespace virtual_work_dynamics {

/// One line that says how far long work is. It appears when work takes long. On a terminal it
/// replaces itself and is wiped out in the end, so that whatever is printed next starts on a clean
/// line; in a log, a line is added now and then.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Where { kNowhere, kTerminal, kLog };

  static Where whereIs(int descriptor) {
    return isatty(descriptor) == 1 ? Where::kTerminal : Where::kLog;
  }

  ProgressLine(std::ostream& stream, Where where)
      : ProgressLine(stream, where,
                     where == Where::kTerminal ? std::chrono::milliseconds(500) : kInLog) {}
  /// @param delay time before the line first appears.
  ProgressLine(std::ostream& stream, Where where, Clock::duration delay)
      : stream_(stream), where_(where), next_(Clock::now() + delay) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether show() would show anything now.
  bool due() const { return where_ != Where::kNowhere && Clock::now() >= next_; }

  void show(const std::string& text) {
    if (!due()) return;
    const bool terminal = where_ == Where::kTerminal;
    next_ = Clock::now() + (terminal ? std::chrono::milliseconds(100) : kInLog);
    stream_ << (terminal ? kWipe : "") << text << (terminal ? "" : "\n") << std::flush;
    shown_ = terminal;
  }

  /// Wipes the line out, before something else is printed.
  void clear() {
    if (shown_) stream_ << kWipe << std::flush;
    shown_ = false;
  }

 private:
  static constexpr std::chrono::milliseconds kInLog{30000};
  static constexpr const char* kWipe = "\r\033[K";

  std::ostream& stream_;
  Where where_;
  Clock::time_point next_;
  bool shown_ = false;
};

/// A time in words, for example "12 s", "3 min" or "2 h".
inline std::string roundedTime(double seconds) {
  if (seconds < 100) return std::to_string(std::lround(seconds)) + " s";
  if (seconds < 6000) return std::to_string(std::lround(seconds / 60)) + " min";
  return std::to_string(std::lround(seconds / 3600)) + " h";
}

/// How far work is, for example ": 40 %, 12 s left", when `done` of `total` took so many seconds.
inline std::string partDone(std::size_t done, std::size_t total, double seconds) {
  std::string text = ": " + std::to_string(100 * done / total) + " %";
  if (done > 0 && done < total) {
    const double left = static_cast<double>(total - done) / static_cast<double>(done);
    text += ", " + roundedTime(seconds * left) + " left";
  }
  return text;
}

/// How far work of unknown length is, for example ": 12000 rows, 3000 each second".
inline std::string countDone(std::size_t done, const std::string& things, double seconds) {
  std::string text = ": " + std::to_string(done) + " " + things;
  if (seconds > 0) {
    text +=
        ", " + std::to_string(std::lround(static_cast<double>(done) / seconds)) + " each second";
  }
  return text;
}

/// A ProgressLine of work whose steps are counted.
class Progress {
 public:
  using Clock = ProgressLine::Clock;
  using Where = ProgressLine::Where;

  /// @param what the work in a word or two.
  template <typename... Delay>
  Progress(std::ostream& stream, Where where, std::string what, Delay... delay)
      : line_(stream, where, delay...), what_(std::move(what)) {}

  void update(std::size_t done, std::size_t total) {
    if (total > 0 && line_.due()) line_.show(what_ + partDone(done, total, seconds()));
  }
  /// For work of unknown length.
  void updateCount(std::size_t done, const std::string& things) {
    if (line_.due()) line_.show(what_ + countDone(done, things, seconds()));
  }

 private:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  ProgressLine line_;
  std::string what_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace virtual_work_dynamics
