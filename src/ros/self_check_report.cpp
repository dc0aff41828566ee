#include "ros/self_check_report.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "base/number_text.h"
#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

// Writes, for example, "0.013 of its magnitude".
std::string share(double residual, const char* whole) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", residual);
  return (std::isfinite(residual) ? text : std::string("an infinite part")) + " of " + whole;
}

}  // namespace

SelfCheckReport::SelfCheckReport(const SelfCheckSettings& settings, CrossCheck* cross_check,
                                 CertificateRecord& certificates)
    : settings_(settings), cross_check_(cross_check), certificates_(certificates) {}

void SelfCheckReport::add(DiagnosticStatusWrapper& status) {
  addCrossCheck(status);
  addCertificates(status);
}

void SelfCheckReport::addCrossCheck(DiagnosticStatusWrapper& status) {
  if (cross_check_ == nullptr) {
    status.add("cross-check", "off");
    return;
  }
  status.add("cross-check", "up to " + numberText(settings_.cross_check_rate) + " a second");
  const CrossCheck::Report report = cross_check_->takeReport();
  if (report.news) latest_finding_ = report.finding;
  status.add("cross-checks done", report.done);
  if (!latest_finding_) return;
  const auto& [largest, where] = *latest_finding_;
  status.addf("cross-check, largest difference (relative)", "%.3g", largest);
  status.add("cross-check, where", printable(where));
  judge(status, largest,
        "cross-check: " + printable(where) + " differs by " + share(largest, "its magnitude") +
            " from Lagrange's equations");
}

void SelfCheckReport::addCertificates(DiagnosticStatusWrapper& status) {
  status.add("certificates", settings_.certificates ? "on" : "off");
  if (!settings_.certificates) return;
  status.add("certificates judge", "arithmetic, not input");
  if (const auto news = certificates_.take()) latest_certificates_ = news;
  if (!latest_certificates_) return;
  const Certificates& latest = *latest_certificates_;
  status.addf("certificate: power (largest, relative)", "%.3g", latest.power);
  status.addf("certificate: ground force (largest, relative)", "%.3g", latest.ground_force);
  status.addf("certificate: ground moment (largest, relative)", "%.3g", latest.ground_moment);
  const char* whole = "the sum of magnitudes";
  judge(status, latest.power, "certificate: power is off balance by " + share(latest.power, whole));
  judge(status, latest.ground_force,
        "certificate: ground's force misses the rate of change of momentum by " +
            share(latest.ground_force, whole));
  judge(status, latest.ground_moment,
        "certificate: ground's moment misses the rate of change of angular momentum by " +
            share(latest.ground_moment, whole));
}

void SelfCheckReport::judge(DiagnosticStatusWrapper& status, double residual,
                            const std::string& text) const {
  if (residual < settings_.residual_warn) return;
  status.mergeSummary(
      residual < settings_.residual_error ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR, text);
}

}  // namespace virtual_work_dynamics
