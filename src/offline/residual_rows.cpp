#include "offline/residual_rows.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <utility>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

std::string secondsText(std::int64_t stamp_ns) {
  return numberText(static_cast<double>(stamp_ns) / 1e9);
}

const char* unitText(Unit unit) {
  return unit == Unit::kRadian ? "N m" : "N";
}

// Of an actuated closure.
const char* unitText(const Scene& scene, const std::string& closure) {
  for (const Closure& one : scene.closures) {
    if (one.name == closure) return unitText(traitsOf(one.type).free_axis.value_or(Unit::kRadian));
  }
  return "";
}

}  // namespace

ResidualRows::ResidualRows(const Mechanism& mechanism, const Dynamics& dynamics, const Scene& scene,
                           MeasuredEfforts measured, double max_gap, const MotionFile& file,
                           const std::string& where)
    : file_(file), max_gap_ns_(std::llround(std::min(max_gap, 1e9) * 1e9)) {
  const Names& efforts = dynamics.effortNames();
  Names unused, lacking, offered;
  for (const MeasuredEffort& effort : measured) offered.push_back(effort.joint());
  for (std::size_t i = 0; i + dynamics.couplings() < efforts.size(); ++i) {
    const auto coordinate = static_cast<Eigen::Index>(i);
    if (dynamics.residuals()[i]) continue;
    if (coordinate < dynamics.coordinates() && !dynamics.actuated()[i]) continue;
    const auto found = std::find(offered.begin(), offered.end(), efforts[i]);
    if (found == offered.end()) {
      lacking.push_back(efforts[i]);
      continue;
    }
    Joint joint{
        coordinate, std::move(measured[static_cast<std::size_t>(found - offered.begin())]), {}};
    joint.compared.joint = efforts[i];
    joint.compared.unit = coordinate < dynamics.coordinates()
                              ? unitText(mechanism.unitOf(static_cast<int>(i)))
                              : unitText(scene, efforts[i]);
    joints_.push_back(std::move(joint));
    found->clear();
  }
  for (const std::string& name : offered) {
    if (!name.empty()) unused.push_back(name);
  }
  const auto known = [&](const std::string& name) {
    return std::find(efforts.begin(), efforts.end(), name) != efforts.end();
  };
  if (joints_.empty() && std::all_of(unused.begin(), unused.end(), known)) {
    throw FileError(where + ": no measured effort is one of an actuator: they are of " +
                    namesInQuotes(unused) + ", and " +
                    (scene.actuators_of.empty() ? "" : "as transmissions are read, ") +
                    "those of " + namesInQuotes(lacking) + " are needed (effort.<name>)");
  }
  if (joints_.empty()) {
    throw FileError(where + ": no measured effort is one of the robot's: they are of " +
                    namesInQuotes(unused) + nameHelp(unused[0], efforts));
  }
  if (!unused.empty()) {
    std::cerr << "note: " << printable(where)
              << ": measured efforts are not used, as none is computed, of "
              << namesInQuotes(unused) << "\n";
  }
  if (!lacking.empty()) {
    std::cerr << "note: " << printable(where) << ": has no measured effort of "
              << namesInQuotes(lacking) << ", which then have no residual\n";
  }
  checkOverlap(where);
}

// Two clocks, or a wrong file, are said before anything is computed.
void ResidualRows::checkOverlap(const std::string& where) const {
  for (const Joint& joint : joints_) {
    for (std::size_t row = 0; row < file_.lines.size(); ++row) {
      if (std::isfinite(joint.measured.at(instantNs(file_, row), max_gap_ns_))) return;
    }
  }
  const MeasuredEffort& measured = joints_.front().measured;
  throw FileError(where + ": efforts were measured from " + secondsText(measured.firstNs()) +
                  " s to " + secondsText(measured.lastNs()) + " s, and the motion is from " +
                  secondsText(instantNs(file_, 0)) + " s to " +
                  secondsText(instantNs(file_, file_.lines.size() - 1)) +
                  " s: no row has a measured effort");
}

void ResidualRows::observe(const Mechanism& mechanism, const Scene& scene, double gain) {
  observer_.emplace(mechanism, scene, gain);
  measured_.setConstant(static_cast<Eigen::Index>(mechanism.coordinates().size()),
                        std::numeric_limits<double>::quiet_NaN());
}

Names ResidualRows::columns(bool deviations) const {
  Names names;
  for (const Joint& joint : joints_) names.push_back("measured_effort." + joint.compared.joint);
  for (const Joint& joint : joints_) names.push_back("measured_residual." + joint.compared.joint);
  for (const Joint& joint : joints_) {
    if (observer_) names.push_back("external_effort." + joint.compared.joint);
  }
  for (const Joint& joint : joints_) {
    if (deviations) names.push_back("deviation.measured_residual." + joint.compared.joint);
  }
  return names;
}

void ResidualRows::add(std::size_t row, const Motion& motion, const Load& load,
                       const Eigen::VectorXd& effort, const DeviationRows* deviations,
                       std::vector<double>& cells) {
  const std::int64_t instant = instantNs(file_, row);
  const std::size_t first = cells.size();
  cells.resize(first + 2 * joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    const double computed = effort[joint.effort];
    const double measured = joint.measured.at(instant, max_gap_ns_);
    cells[first + i] = measured;
    cells[first + joints_.size() + i] = computed - measured;
    if (!std::isfinite(computed - measured)) continue;
    joint.compared.times.push_back(file_.table.times[row]);
    joint.compared.computed.push_back(computed);
    joint.compared.measured.push_back(measured);
    const bool moves = joint.effort < motion.qd.size();
    joint.compared.velocities.push_back(moves ? motion.qd[joint.effort] : 0);
  }
  if (observer_) addObserved(row, motion, load, cells);
  if (!deviations) return;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const bool exists = std::isfinite(cells[first + joints_.size() + i]);
    cells.push_back(exists ? deviations->ofEffort(joints_[i].effort)
                           : std::numeric_limits<double>::quiet_NaN());
  }
}

// Its measured efforts are those of the row's first cells.
void ResidualRows::addObserved(std::size_t row, const Motion& motion, const Load& load,
                               std::vector<double>& cells) {
  const std::size_t first = cells.size() - 2 * joints_.size();
  for (std::size_t i = 0; i < joints_.size(); ++i) measured_[joints_[i].effort] = cells[first + i];
  const std::vector<double>& times = file_.table.times;
  if (row > 0) {
    const double length = times[row] - times[row - 1];
    if (!(length > 0)) {
      throw FileError(file_.at(row) + ": time " + numberText(times[row]) + " is not later than " +
                      numberText(times[row - 1]) + " in the row before, as --observer-gain needs");
    }
    if (length * 1e9 > static_cast<double>(max_gap_ns_)) observer_->restart();
  }
  observer_->step(times[row], motion, load, measured_);
  for (const Joint& joint : joints_) cells.push_back(observer_->external()[joint.effort]);
}

std::string ResidualRows::table() const {
  std::vector<ComparedEfforts> compared;
  for (const Joint& joint : joints_) compared.push_back(joint.compared);
  return comparisonTable(compared);
}

}  // namespace virtual_work_dynamics
