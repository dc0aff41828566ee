#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "ros/counters.h"
#include "ros/deviation_report.h"
#include "ros/joint_watch.h"
#include "ros/loop_report.h"
#include "ros/self_check_report.h"
#include "ros/stream_report.h"
#include "ros/threshold_report.h"

namespace virtual_work_dynamics {

/// Reports the counters on /diagnostics. Serves one thread.
class Diagnostics {
 public:
  /// @param period s.
  Diagnostics(const Counters& counters_read, RunTimeHistogram& run_times, const JointWatch& joints,
              const SelfCheckReport& self_check, const LoopReport& loops,
              const StreamReport& streams, const DeviationReport& deviations,
              const ThresholdReport& thresholds, const std::string& robot, double period);

  /// Sets the outputs that are subscribed to now.
  void setOutputs(const std::vector<std::string>& outputs);
  /// Sets what the node computes for them.
  void setPlan(const std::string& plan, const std::string& operations);

  /// Publishes when the period is over.
  void update(JointWatch::Clock::time_point now);

 private:
  /// Counts at the report before, for rates and news.
  struct Before {
    JointWatch::Clock::time_point time;
    std::uint64_t inputs = 0;
    std::uint64_t accepted = 0;
    std::uint64_t restarts = 0;
    std::uint64_t gaps = 0;
    std::uint64_t motions = 0;  ///< from the estimator, computed or not
    std::uint64_t outputs = 0;
    std::uint64_t samples = 0;
    std::uint64_t late = 0;
    std::uint64_t dropped = 0;
  };

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper& status, const Before& now,
                 const std::vector<std::string>& missing) const;
  void addRunTimes(diagnostic_updater::DiagnosticStatusWrapper& status);
  void addCounts(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  Before count() const;

  const Counters& counters_;
  RunTimeHistogram& run_times_;
  const JointWatch& joints_;
  SelfCheckReport self_check_;
  LoopReport loops_;
  StreamReport streams_;
  DeviationReport deviations_;
  ThresholdReport thresholds_;
  const std::chrono::nanoseconds period_;
  JointWatch::Clock::time_point next_;
  Before before_;
  RunTimeHistogram::Summary latest_run_times_;
  std::string outputs_ = "none";
  std::string operations_;
  std::string plan_ = "nothing";
  diagnostic_updater::Updater updater_;
};

}  // namespace virtual_work_dynamics
