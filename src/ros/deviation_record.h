#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/effort_doubts.h"

namespace virtual_work_dynamics {

/// Which efforts have deviations that are large beside them. One thread records and another one
/// takes reports; the recording one neither waits nor allocates.
class DeviationRecord {
 public:
  /// With the arguments of EffortDoubts.
  DeviationRecord(std::vector<std::string> efforts, std::vector<bool> residuals,
                  std::vector<std::string> coordinates, std::vector<std::string> others = {})
      : doubts_(std::move(efforts), std::move(residuals), std::move(coordinates),
                std::move(others)) {}

  /// Records the deviations of a sample, of which the share of the motion is computed. A sample
  /// that comes while a report is taken is left out.
  void record(const Eigen::VectorXd& effort, const Deviations::Workspace& computed,
              bool of_description) {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock) doubts_.add(effort, computed, true, of_description);
  }

  struct Report {
    std::size_t samples = 0;          ///< since the report before
    std::vector<EffortDoubt> doubts;  ///< deviations of these samples, efforts of all
  };
  /// @param threshold deviations over efforts, each an rms, above which an effort is in doubt
  Report take(double threshold) {
    const std::lock_guard<std::mutex> lock(mutex_);
    Report report{doubts_.samples(), doubts_.above(threshold)};
    doubts_.forgetDeviations();
    return report;
  }

 private:
  std::mutex mutex_;
  EffortDoubts doubts_;
};

}  // namespace virtual_work_dynamics
