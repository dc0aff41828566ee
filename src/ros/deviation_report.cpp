#include "ros/deviation_report.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <string>

namespace virtual_work_dynamics {

void DeviationReport::add(diagnostic_updater::DiagnosticStatusWrapper& status) {
  constexpr std::size_t kMost = 3;
  const DeviationRecord::Report report = record_->take(threshold_);
  if (report.samples == 0) {
    status.add("efforts in doubt", "no deviations are computed");
    return;
  }
  std::string text;
  for (std::size_t i = 0; i < report.doubts.size() && i < kMost; ++i) {
    text += (i == 0 ? "" : "; ") + toString(report.doubts[i]);
  }
  if (report.doubts.size() > kMost) {
    text += "; and " + std::to_string(report.doubts.size() - kMost) + " more";
  }
  status.add("efforts in doubt", text.empty() ? "none" : text);
  if (!text.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, text);
}

}  // namespace virtual_work_dynamics
