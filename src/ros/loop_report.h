#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ros/loop_record.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Describes, in lines for the log, the closed loops in their assembled position.
/// @param condition_warn larger conditions are close to a singular position
/// @param everything Dynamics of all that the scene asks for, in both axes
std::vector<std::string> loopLines(const Mechanism& mechanism, const Scene& scene,
                                   const Dynamics& everything, double condition_warn);

/// Reports on /diagnostics how far motions violate the loops, what is determined and whether
/// positions were singular. Serves one thread.
class LoopReport {
 public:
  /// @param mechanism must outlive this
  /// @param dynamics of the mechanism and the scene; for an open chain there is nothing to report
  /// @param reactions those that the scene asks for
  LoopReport(const Mechanism& mechanism, const Dynamics& dynamics,
             std::vector<std::string> reactions, LoopRecord& record);

  /// Adds what was recorded since the call before, and to the summary what is wrong with it.
  /// Residuals stay until there are new ones.
  void add(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void addResiduals(diagnostic_updater::DiagnosticStatusWrapper& status,
                    const LoopRecord::Report& report) const;
  void addViolations(diagnostic_updater::DiagnosticStatusWrapper& status,
                     const LoopRecord::Report& report) const;
  void addFit(diagnostic_updater::DiagnosticStatusWrapper& status, const FitSummary& fit);
  void addConditions(diagnostic_updater::DiagnosticStatusWrapper& status,
                     const std::vector<double>& conditions) const;
  void addHolds(diagnostic_updater::DiagnosticStatusWrapper& status,
                const LoopRecord::Report& report) const;
  void addLeftOut(diagnostic_updater::DiagnosticStatusWrapper& status,
                  const LoopRecord::Report& report, const std::string& why) const;

  const Mechanism& mechanism_;
  std::vector<std::string> closures_, labels_, one_sided_, efforts_, reactions_;
  bool closed_;
  LoopRecord& record_;
  LoopLimits limits_;
  LoopRecord::Report latest_;  // the last one with news
  std::uint64_t singular_ = 0, undirected_ = 0, violations_ = 0;
  std::uint64_t fitted_ = 0, unexplained_ = 0;  // ever
};

}  // namespace virtual_work_dynamics
