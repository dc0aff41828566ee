#include "offline/extra_columns.h"

#include <iterator>
#include <utility>

#include "base/printable.h"
#include "motion/free_columns.h"
#include "robot/effort_limits.h"

namespace virtual_work_dynamics {

ExtraColumns::ExtraColumns(const Arguments& arguments, const Mechanism& mechanism,
                           const Scene& scene, const Dynamics& dynamics, const Request& written,
                           const MotionFile& file, MeasuredEfforts measured, Columns& columns)
    : arguments_(arguments), mechanism_(mechanism), file_(file), holds_(dynamics.oneSided()) {
  const auto append = [&](const std::vector<std::string>& names) {
    columns.more.insert(columns.more.end(), names.begin(), names.end());
  };
  if (arguments.certificates) {
    certified_.emplace(mechanism, dynamics);
    append({std::begin(kCertificateColumns), std::end(kCertificateColumns)});
  }
  if (arguments.deviations) {
    deviations_.emplace(mechanism, scene, written, file.table, arguments.motion.name());
    append(deviations_->columns(columns));
  }
  if (arguments.residuals) {
    residuals_.emplace(mechanism, dynamics, scene, std::move(measured),
                       arguments.recording.completion.max_gap, file,
                       arguments.measuredSource().name());
    if (arguments.observer_gain) residuals_->observe(mechanism, scene, *arguments.observer_gain);
    append(residuals_->columns(arguments.deviations));
  }
  if (dynamics.closed() && !arguments.report.empty()) {
    report_.emplace(mechanism, scene);
    append(report_->names());
  }
  if (!arguments.report.empty() && !file.one_sided.empty()) append({"one_sided"});
  if (arguments.positions) append(motionColumns(mechanism));
  if (arguments.effort_limits) {
    limits_.emplace(mechanism.coordinateNames(), effortLimits(mechanism));
  }
}

void ExtraColumns::add(std::size_t row, const Motion& motion, const Load& load,
                       const Results& results, const Eigen::VectorXd& effort,
                       std::vector<double>& cells) {
  if (certified_) certified_->check(motion, load, results, file_.lines[row], cells);
  if (deviations_) deviations_->add(row, motion, load, results, cells);
  if (residuals_) {
    residuals_->add(row, motion, load, effort, deviations_ ? &*deviations_ : nullptr, cells);
  }
  if (report_) report_->add(motion, results, cells);
  if (!arguments_.report.empty() && !file_.one_sided.empty()) {
    cells.push_back(file_.one_sided[row] ? 1 : 0);
  }
  if (arguments_.positions) appendMotion(mechanism_, motion, cells);
  holds_.add(row, results);
  if (limits_) limits_->add(file_.table.times[row], results);
}

std::string ExtraColumns::notes() const {
  const std::string file = printable(arguments_.motion.name());
  std::string text;
  if (certified_) {
    text += "note: " + file +
            ": certificates judge arithmetic, not input: " + certified_->summary(file_.row_name) +
            "\n";
  }
  text += holds_.text(file_);
  if (limits_) text += limits_->text(file);
  if (deviations_) {
    text += deviations_->notes(arguments_.deviation_warn.value_or(kDeviationWarn));
  }
  if (residuals_) {
    text += "note: " + printable(arguments_.measuredSource().name()) +
            ": computed less measured efforts:\n" + residuals_->table();
  }
  return text;
}

}  // namespace virtual_work_dynamics
