#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// The message that says which results of a mechanism with closed loops rigid-body mechanics
/// determines, and whether that has changed. Serves one thread.
class DeterminacyMessage {
 public:
  /// @param efforts names of what has an effort
  /// @param reactions those that the scene asks for
  /// @param condition_warn a position with a larger condition is close to a singular one
  DeterminacyMessage(const std::string& robot, std::vector<std::string> efforts,
                     std::vector<std::string> reactions, double condition_warn);

  /// Takes the flags of a sample.
  /// @param results of everything that the scene asks for, in both axes
  /// @param root_places places of the flags of each reaction in `results`, in root axes
  /// @param child_places their places in child axes
  /// @returns whether ranks, counts, flags, or being close to a singular position differ from
  ///   before; it allocates only then
  bool update(std::int64_t stamp_ns, const LoopResults& results,
              const std::vector<std::size_t>& root_places,
              const std::vector<std::size_t>& child_places);

  /// The message, with three statuses: numbers and efforts; reactions in root axes; reactions in
  /// child axes. Keys of flags are names of efforts, and <name>.fx to <name>.tz.
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

/// The message about the assembled position.
/// @param everything Dynamics of all that the scene asks for, in both axes, in the order of
/// `reactions`
DeterminacyMessage assembledDeterminacy(const Mechanism& mechanism, const Dynamics& everything,
                                        const std::vector<std::string>& reactions,
                                        double condition_warn);

}  // namespace virtual_work_dynamics
