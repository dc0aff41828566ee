#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <array>
#include <string>
#include <vector>

#include "ros/stream_record.h"

namespace virtual_work_dynamics {

/// Reports on /diagnostics what the joint states of each joint, and the messages of the root's
/// motion, were found to be, and which of them contradict themselves. Serves one thread.
class StreamReport {
 public:
  /// @param joints names of the coordinates   @param units rad or m, of each
  StreamReport(const StreamRecord& record, std::vector<std::string> joints,
               std::vector<std::string> units);

  void add(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::string problem(std::size_t joint) const;
  void warnOfFarPositions(std::size_t joint);
  void addRoot(diagnostic_updater::DiagnosticStatusWrapper& status);

  const StreamRecord& record_;
  const std::vector<std::string> joints_;
  const std::vector<std::string> units_;
  std::vector<JointStream> streams_;
  std::vector<RootStream> root_;
  std::array<bool, RootCourse::kMostStreams> root_warned_{};
  std::vector<bool> warned_;  // of each joint, in the log
  std::vector<bool> warned_of_far_positions_;
};

}  // namespace virtual_work_dynamics
