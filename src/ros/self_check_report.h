#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <optional>
#include <string>

#include "ros/certificate_record.h"
#include "ros/cross_check.h"
#include "ros/inverse_dynamics_parameters.h"

namespace virtual_work_dynamics {

/// Reports on /diagnostics what checks of the node's results have found. Serves one thread.
class SelfCheckReport {
 public:
  /// @param cross_check null when off
  /// @param certificates of all samples, if settings turn them on
  SelfCheckReport(const SelfCheckSettings& settings, CrossCheck* cross_check,
                  CertificateRecord& certificates);

  /// Adds the findings since the call before, and to the summary what is wrong with them. Findings
  /// stay until there are new ones.
  void add(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void addCrossCheck(diagnostic_updater::DiagnosticStatusWrapper& status);
  void addCertificates(diagnostic_updater::DiagnosticStatusWrapper& status);
  void judge(diagnostic_updater::DiagnosticStatusWrapper& status, double residual,
             const std::string& text) const;

  const SelfCheckSettings settings_;
  CrossCheck* const cross_check_;
  CertificateRecord& certificates_;
  std::optional<CrossCheckSlot::Finding> latest_finding_;
  std::optional<Certificates> latest_certificates_;
};

}  // namespace virtual_work_dynamics
