#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "ros/rejection.h"

namespace virtual_work_dynamics {

/// What was amiss with the messages of a topic: how often, and the first time in words.
class Happenings {
 public:
  /// The next message comes, the first one being number 1.
  void next() { ++messages_; }
  std::size_t messages() const { return messages_; }

  void drop(DropReason reason, const std::string& text) { drop(reason, text, messages_); }
  /// @param message the number of the one that is dropped
  void drop(DropReason reason, const std::string& text, std::size_t message) {
    happen(dropped_[reason], text, message);
  }
  void warn(const std::string& text) { happen(doubts_[text], text); }
  void gap(const std::string& text) { happen(gaps_, text); }
  void restart(const std::string& text) { happen(restarts_, text); }
  void leaveForeign(const std::string& text) { happen(foreign_, text); }
  void change(const std::string& text) { happen(changes_, text); }

  /// A line for each kind: warnings, then notes. @param where to stand before each
  std::string report(const std::string& where) const;

 private:
  struct Happening {
    std::size_t count = 0;
    std::string first;
  };

  void happen(Happening& happening, const std::string& text) { happen(happening, text, messages_); }
  static void happen(Happening& happening, const std::string& text, std::size_t message);

  std::size_t messages_ = 0;
  std::map<DropReason, Happening> dropped_;
  std::map<std::string, Happening> doubts_;  // by text
  Happening foreign_, gaps_, restarts_, changes_;
};

}  // namespace virtual_work_dynamics
