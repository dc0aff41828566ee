#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ros/loop_record.h"
#include "ros/loop_samples.h"

namespace virtual_work_dynamics {

/// Lines for the log: what the closed loops are like where they were assembled.
std::vector<std::string> loopLines(const Mechanism& mechanism, const Scene& scene,
                                   const LoopSamples& loops);

/// How far motions violate the loops, what is determined and where positions were singular, for
/// /diagnostics. One thread.
class LoopReport {
 public:
  /// @param reactions that the scene asks for. @param record null: an open chain, nothing to
  /// report.
  LoopReport(const Mechanism& mechanism, const Scene& scene, std::vector<std::string> reactions,
             LoopRecord* record, const LoopLimits& limits);

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
  LoopRecord* record_;
  LoopLimits limits_;
  LoopRecord::Report latest_;  // that had news
  std::uint64_t singular_ = 0, violations_ = 0;
};

}  // namespace virtual_work_dynamics
