#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <cstdint>
#include <string>
#include <vector>

#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// What rigid-body mechanics determines of all results of a mechanism with closed loops, as a
/// message, and whether that has changed. One thread.
class DeterminacyMessage {
 public:
  /// @param efforts names of what has an effort. @param reactions that the scene asks for.
  /// @param condition_warn a larger condition is close to a singular position.
  DeterminacyMessage(const std::string& robot, std::vector<std::string> efforts,
                     std::vector<std::string> reactions, double condition_warn);

  /// @param results of everything that the scene asks for, in both axes; other reactions may follow
  /// in child axes.
  /// @returns whether ranks, counts, flags, or being close to a singular position differ from
  /// before. Allocates only then.
  bool update(std::int64_t stamp_ns, const ClosedLoopDynamics& results);

  /// Three statuses: numbers and efforts; reactions in root axes; reactions in child axes. Keys of
  /// flags are names of efforts, and <name>.fx to <name>.tz.
  const diagnostic_msgs::DiagnosticArray& message() const { return message_; }

 private:
  bool changed(const ClosedLoopDynamics& results) const;
  bool isClose(const Determinacy& determinacy) const;
  void write();

  const std::vector<std::string> efforts_, reactions_;
  const double condition_warn_;
  Determinacy determinacy_;
  std::vector<bool> effort_;
  std::vector<Determined> root_axes_, child_axes_;
  diagnostic_msgs::DiagnosticArray message_;
};

}  // namespace virtual_work_dynamics
