#include "ros/diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include "base/printable.h"
#include "ros/message_text.h"
#include "ros/private_name.h"

namespace virtual_work_dynamics {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

// Share of late outputs above which the node warns.
constexpr double kLateShare = 0.001;
// Restarts between two reports from which on the node warns: a looped bag makes one now and then.
constexpr std::uint64_t kManyRestarts = 3;

double seconds(JointWatch::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

void addMicroseconds(DiagnosticStatusWrapper& status, const char* key, std::int64_t nanoseconds) {
  status.addf(key, "%.3f", static_cast<double>(nanoseconds) * 1e-3);
}

}  // namespace

Diagnostics::Diagnostics(const Counters& counters_read, RunTimeHistogram& run_times,
                         const JointWatch& joints, const SelfCheckReport& self_check,
                         const LoopReport& loops, const StreamReport& streams,
                         const DeviationReport& deviations, const ThresholdReport& thresholds,
                         const std::string& robot, double period)
    : counters_(counters_read),
      run_times_(run_times),
      joints_(joints),
      self_check_(self_check),
      loops_(loops),
      streams_(streams),
      deviations_(deviations),
      thresholds_(thresholds),
      period_(std::chrono::duration_cast<std::chrono::nanoseconds>(
          std::chrono::duration<double>(period))),
      next_(JointWatch::Clock::now() + period_) {
  before_.time = JointWatch::Clock::now();
  updater_.setHardwareID(shortened(robot));
  updater_.add("inverse dynamics", this, &Diagnostics::report);
}

void Diagnostics::setOutputs(const std::vector<std::string>& outputs) {
  outputs_.clear();
  for (const std::string& output : outputs) outputs_ += (outputs_.empty() ? "" : ", ") + output;
  if (outputs.empty()) outputs_ = "none";
}

void Diagnostics::setPlan(const std::string& plan, const std::string& operations) {
  plan_ = plan;
  operations_ = operations;
}

void Diagnostics::update(JointWatch::Clock::time_point now) {
  if (now < next_) return;
  next_ += period_;
  // A pause is not followed by a burst of reports.
  if (next_ < now) next_ = now + period_;
  // Updater::update() would go by ROS time, which a looping bag turns back.
  updater_.force_update();
}

Diagnostics::Before Diagnostics::count() const {
  Before now;
  now.time = JointWatch::Clock::now();
  now.inputs = counters_.joint_states.value() + counters_.free_joints.value() +
               counters_.trajectories.value();
  now.accepted = counters_.accepted_joint_states.value();
  now.restarts = counters_.restarts.value();
  now.gaps = counters_.gaps.value();
  now.motions = counters_.samples.value() + counters_.skipped.value();
  now.outputs = counters_.outputs.value();
  now.samples = counters_.samples.value();
  now.late = counters_.late.value();
  now.dropped = counters_.allDropped();
  return now;
}

void Diagnostics::report(DiagnosticStatusWrapper& status) {
  // Before those that the summary is of, which go on counting: what a value has is in the summary,
  // or in an earlier one.
  DiagnosticStatusWrapper counts;
  addCounts(counts);
  const Before now = count();
  // A joint that has stopped counts as missing only while others go on, one that was never received
  // from the first joint state on.
  std::vector<std::string> missing;
  if (now.accepted > before_.accepted) {
    missing = joints_.missing();
  } else if (now.accepted > 0) {
    missing = joints_.neverSeen();
  }
  const double interval = seconds(now.time - before_.time);
  summarize(status, now, missing);
  status.addf("input rate (Hz)", "%.2f",
              static_cast<double>(now.inputs - before_.inputs) / interval);
  status.addf("output rate (Hz)", "%.2f",
              static_cast<double>(now.outputs - before_.outputs) / interval);
  addRunTimes(status);
  self_check_.add(status);
  loops_.add(status);
  streams_.add(status);
  deviations_.add(status);
  thresholds_.add(status);
  status.values.insert(status.values.end(), counts.values.begin(), counts.values.end());
  status.add("joints waited for", missing.empty() ? "none" : shortList(missing));
  status.add("subscribed outputs", outputs_);
  status.add("computed", plan_);
  if (!operations_.empty()) status.add("operations a sample", operations_);
  before_ = now;
}

void Diagnostics::summarize(DiagnosticStatusWrapper& status, const Before& now,
                            const std::vector<std::string>& missing) const {
  status.summary(DiagnosticStatus::OK, now.inputs == 0 ? "no input yet" : "running");
  if (now.dropped > before_.dropped) {
    status.mergeSummaryf(DiagnosticStatus::WARN, "%llu dropped, the last: %s",
                         static_cast<unsigned long long>(now.dropped - before_.dropped),
                         counters_.lastDrop().c_str());
  }
  if (!missing.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, "waiting for joints: " + shortList(missing));
  }
  const std::uint64_t restarts = now.restarts - before_.restarts;
  const std::uint64_t gaps = now.gaps - before_.gaps;
  if (gaps > 0 && now.motions == before_.motions) {
    status.mergeSummaryf(
        DiagnosticStatus::WARN, "no result from joint states: they had %llu gaps longer than %s",
        static_cast<unsigned long long>(gaps), privateName("estimator/max_gap").c_str());
  }
  if (restarts >= kManyRestarts) {
    status.mergeSummaryf(DiagnosticStatus::WARN,
                         "the stamps of joint states went back %llu times: are there two "
                         "publishers with clocks of their own?",
                         static_cast<unsigned long long>(restarts));
  }
  const auto late = static_cast<double>(now.late - before_.late);
  const auto samples = static_cast<double>(now.samples - before_.samples);
  if (late > kLateShare * samples) {
    status.mergeSummaryf(DiagnosticStatus::WARN, "%.2f %% of outputs late",
                         samples > 0 ? 100 * late / samples : 100.0);
  }
}

void Diagnostics::addRunTimes(DiagnosticStatusWrapper& status) {
  const RunTimeHistogram::Summary summary = run_times_.takeSummary();
  if (summary.count > 0) latest_run_times_ = summary;
  if (latest_run_times_.count == 0) return;
  addMicroseconds(status, "run time per sample, median (us)", latest_run_times_.median_ns);
  addMicroseconds(status, "run time per sample, p99 (us)", latest_run_times_.p99_ns);
  addMicroseconds(status, "run time per sample, worst (us)", latest_run_times_.worst_ns);
}

void Diagnostics::addCounts(DiagnosticStatusWrapper& status) const {
  status.add("joint states received", counters_.joint_states.value());
  status.add("messages of joints that turn freely received", counters_.free_joints.value());
  status.add("trajectories received", counters_.trajectories.value());
  status.add("samples computed", counters_.samples.value());
  status.add("trajectory points computed", counters_.points.value());
  status.add("trajectory samples computed", counters_.sampled.value());
  status.add("samples nobody listened for", counters_.skipped.value());
  status.add("restarts", counters_.restarts.value());
  status.add("gaps", counters_.gaps.value());
  status.add("joint states put in order", counters_.reordered.value());
  status.add("joint states of other robots", counters_.foreign.value());
  status.add("joint states with velocities that are not finite",
             counters_.velocity_not_finite.value());
  status.add("samples with a joint held", counters_.held.value());
  status.add("wrenches received", counters_.wrenches.value());
  status.add("payloads and gravity received", counters_.payloads.value());
  status.add("samples with a wrench held", counters_.wrench_held.value());
  status.add("root messages received", counters_.roots.value());
  status.add("restarts of the root", counters_.root_restarts.value());
  status.add("gaps of the root", counters_.root_gaps.value());
  status.add("root messages put in order", counters_.root_reordered.value());
  status.add("root messages with rates that are not finite", counters_.root_twist_left.value());
  status.add("samples with the root foreseen", counters_.root_foreseen.value());
  status.add("late outputs", counters_.late.value());
  status.add("dropped", counters_.allDropped());
  for (std::size_t i = 0; i < kDropReasonNames.size(); ++i) {
    status.add(std::string("dropped: ") + kDropReasonNames[i], counters_.dropped[i].value());
  }
  const std::string last = counters_.lastDrop();
  status.add("last drop", last.empty() ? "none" : last);
}

}  // namespace virtual_work_dynamics
