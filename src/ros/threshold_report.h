#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <memory>

#include "ros/threshold_record.h"

namespace virtual_work_dynamics {

/// Reports on /diagnostics which joints have external efforts beyond their thresholds, and efforts
/// beyond their limits. Serves one thread.
class ThresholdReport {
 public:
  /// @param external of external efforts, null: no thresholds are set
  /// @param limits of efforts, null: limits are not looked at
  ThresholdReport(std::shared_ptr<ThresholdRecord> external,
                  std::shared_ptr<ThresholdRecord> limits);

  /// Adds what was recorded since the call before, and WARN with the joints' names to the summary.
  void add(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::shared_ptr<ThresholdRecord> external_, limits_;
};

}  // namespace virtual_work_dynamics
