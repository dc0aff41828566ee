#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <memory>
#include <utility>

#include "ros/deviation_record.h"

namespace virtual_work_dynamics {

/// Reports on /diagnostics which efforts are in doubt, while deviations are computed. Serves one
/// thread.
class DeviationReport {
 public:
  /// @param threshold see DeviationRecord::take()
  DeviationReport(std::shared_ptr<DeviationRecord> record, double threshold)
      : record_(std::move(record)), threshold_(threshold) {}

  /// Adds what was recorded since the call before, and to the summary which efforts are in doubt
  /// and why.
  void add(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::shared_ptr<DeviationRecord> record_;
  double threshold_;
};

}  // namespace virtual_work_dynamics
