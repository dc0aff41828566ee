#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ros/loop_record.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Lines for the log: what the closed loops are like where they were assembled.
/// @param everything Dynamics of all that the scene asks for, in both axes
std::vector<std::string> loopLines(const Mechanism& mechanism, const Scene& scene,
                                   const Dynamics& everything);

/// How far motions violate the loops, what is determined and where positions were singular, for
/// /diagnostics. One thread.
class LoopReport {
 public:
  /// @param dynamics of the mechanism and the scene; of an open chain there is nothing to report
  /// @param reactions that the scene asks for
  LoopReport(const Dynamics& dynamics, std::vector<std::string> reactions, LoopRecord& record,
             const LoopLimits& limits);

  /// Adds what samples since the call before were like, and to the summary what is wrong with them.
  /// Residuals hold until there are others.
  void add(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void addResiduals(diagnostic_updater::DiagnosticStatusWrapper& status,
                    const LoopRecord::Report& report) const;
  void addViolations(diagnostic_updater::DiagnosticStatusWrapper& status,
                     const LoopRecord::Report& report) const;
  void addConditions(diagnostic_updater::DiagnosticStatusWrapper& status,
                     const std::vector<double>& conditions) const;
  void addSingular(diagnostic_updater::DiagnosticStatusWrapper& status,
                   const LoopRecord::Report& report) const;

  std::vector<std::string> closures_, efforts_, reactions_;
  bool closed_;
  LoopRecord& record_;
  LoopLimits limits_;
  LoopRecord::Report latest_;  // that had news
  std::uint64_t singular_ = 0, violations_ = 0;
};

}  // namespace virtual_work_dynamics
