#include "ros/threshold_report.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cstdio>
#include <string>
#include <utility>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

using diagnostic_updater::DiagnosticStatusWrapper;

std::string excessText(const ThresholdRecord::Excess& excess) {
  constexpr std::size_t kLongest = 128;
  char text[kLongest];
  std::snprintf(text, sizeof text, " %.4g, more than %.4g, for %.3g s", excess.peak,
                excess.threshold, excess.seconds);
  return inQuotes(excess.name) + text;
}

void addExcess(DiagnosticStatusWrapper& status, ThresholdRecord& record, const char* key,
               const char* what) {
  constexpr std::size_t kMostNamed = 3;
  std::string text;
  std::size_t count = 0;
  for (const ThresholdRecord::Excess& excess : record.take()) {
    if (++count <= kMostNamed) text += (count == 1 ? "" : ", ") + excessText(excess);
  }
  if (count > kMostNamed) text += " and " + std::to_string(count - kMostNamed) + " more";
  status.add(key, count == 0 ? "none" : text);
  if (count == 0) return;
  status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, what + (" of " + text));
}

}  // namespace

ThresholdReport::ThresholdReport(std::shared_ptr<ThresholdRecord> external,
                                 std::shared_ptr<ThresholdRecord> limits)
    : external_(std::move(external)), limits_(std::move(limits)) {}

void ThresholdReport::add(DiagnosticStatusWrapper& status) {
  if (external_) addExcess(status, *external_, "external efforts", "external effort");
  if (limits_) addExcess(status, *limits_, "efforts beyond limits", "effort beyond its limit");
}

}  // namespace virtual_work_dynamics
