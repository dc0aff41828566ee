#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// What rigid-body mechanics determines of all results of a mechanism with closed loops, as a
/// message, and whether that has changed. One thread.
class DeterminacyMessage {
 public:
  /// @param efforts names of what has an effort. @param reactions that the scene asks for.
  /// @param condition_warn a larger condition is close to a singular position.
  DeterminacyMessage(const std::string& robot, std::vector<std::string> efforts,
                     std::vector<std::string> reactions, double condition_warn);

  /// @param results of everything that the scene asks for, in both axes
  /// @param root_places where the flags of each reaction stand in `results`, root axes
  /// @param child_places the places in child axes
  /// @returns whether ranks, counts, flags, or being close to a singular position differ from
  /// before. Allocates only then.
  bool update(std::int64_t stamp_ns, const LoopResults& results,
              const std::vector<std::size_t>& root_places,
              const std::vector<std::size_t>& child_places);

  /// Three statuses: numbers and efforts; reactions in root axes; reactions in child axes. Keys of
  /// flags are names of efforts, and <name>.fx to <name>.tz.
  const diagnostic_msgs::DiagnosticArray& message() const { return message_; }

 private:
  bool isClose(const Determinacy& determinacy) const;
  void write();

  const std::vector<std::string> efforts_, reactions_;
  const double condition_warn_;
  Determinacy determinacy_;
  std::vector<bool> effort_;
  std::vector<Determined> root_axes_, child_axes_;
  diagnostic_msgs::DiagnosticArray message_;
};

/// What is determined where the closures are assembled.
/// @param everything Dynamics of all that the scene asks for, in both axes, in the order of
/// `reactions`
DeterminacyMessage assembledDeterminacy(const Mechanism& mechanism, const Dynamics& everything,
                                        const std::vector<std::string>& reactions,
                                        double condition_warn);

}  // namespace virtual_work_dynamics
