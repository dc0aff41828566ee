#include "offline/deviation_rows.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/sample_rows.h"
#include "offline/arguments.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Names like "deviation.effort.elbow" and "deviation.elbow.fx".
void addColumns(const std::string& what, const Columns& results,
                std::vector<std::string>& columns) {
  for (std::size_t i = 0; i < results.efforts.size(); ++i) {
    columns.push_back(what + "." + results.effortColumn(i));
  }
  for (const std::string& name : results.reactions) {
    for (const char* component : kWrenchComponents) {
      columns.push_back(what + "." + name + "." + component);
    }
  }
}

void addCells(const StandardDeviations& deviations, bool efforts, std::vector<double>& cells) {
  for (Eigen::Index i = 0; efforts && i < deviations.effort.size(); ++i) {
    cells.push_back(deviations.effort[i]);
  }
  for (const auto* wrenches : {&deviations.child_axes, &deviations.root_axes}) {
    for (const Wrench& wrench : *wrenches) {
      for (int i = 0; i < 3; ++i) cells.push_back(wrench.force[i]);
      for (int i = 0; i < 3; ++i) cells.push_back(wrench.torque[i]);
    }
  }
}

// Whether there is anything that a share of the motion comes from.
bool anyDoubt(const Scene& scene, const MotionTable& table) {
  const auto doubtful = [](const AppliedWrench& wrench) { return wrench.deviation.has_value(); };
  const auto estimated = [](const FreeTurns& turns) { return !turns.covariances.empty(); };
  return table.hasCovariances() || !table.root_covariances.empty() ||
         std::any_of(table.turns.begin(), table.turns.end(), estimated) ||
         std::any_of(scene.applied_wrenches.begin(), scene.applied_wrenches.end(), doubtful);
}

// What has no deviation, as nothing of it is estimated, or as the scene does not say it.
std::vector<std::string> exactParts(const Scene& scene, const MotionTable& table) {
  std::vector<std::string> parts;
  if (scene.root_moves && table.root_covariances.empty())
    parts.emplace_back("the root's motion, as it is given");
  for (const FreeTurns& turns : table.turns) {
    if (turns.covariances.empty())
      parts.push_back("the orientation of " + inQuotes(turns.joint) + ", as its rates are given");
  }
  for (const std::string& wrench : exactWrenches(scene))
    parts.push_back("the wrench " + inQuotes(wrench) + ", which the scene gives no deviation");
  return parts;
}

// By how much a row violates the loops, relative.
double violationOf(const Results& results) {
  double most = 0;
  for (const ClosureResidual& residual : results.loops.relative_residuals)
    most = std::max({most, residual.position, residual.velocity, residual.acceleration});
  return most;
}

}  // namespace

DeviationRows::DeviationRows(const Mechanism& mechanism, const Scene& scene, const Request& request,
                             const MotionTable& table, const std::string& path)
    : mechanism_(mechanism),
      table_(table),
      path_(path),
      of_motion_(anyDoubt(scene, table)),
      deviations_(mechanism, scene, request),
      workspace_(deviations_.makeWorkspace()),
      exact_(exactParts(scene, table)) {
  if (!of_motion_ && !deviations_.hasTolerances()) {
    throw Error(path +
                ": --deviations: the error of this motion is not known, as nothing of it is "
                "estimated, and the scene has no tolerances and no deviations of wrenches");
  }
  covariance_.coordinates.resize(table.joints.size());
  if (request.efforts) {
    doubts_.emplace(deviations_.effortNames(), deviations_.residuals(), mechanism.coordinateNames(),
                    otherCauses(scene));
  }
}

std::vector<std::string> DeviationRows::columns(const Columns& results) const {
  std::vector<std::string> names;
  if (of_motion_) addColumns("deviation", results, names);
  if (deviations_.hasTolerances()) addColumns("tolerance", results, names);
  return names;
}

void DeviationRows::add(std::size_t row, const Motion& motion, const Load& load,
                        const Results& results, std::vector<double>& cells) {
  const bool of_description = deviations_.hasTolerances();
  const bool efforts = doubts_.has_value();
  if (of_motion_) {
    takeCovariance(mechanism_, table_, row, covariance_);
    deviations_.computeMotion(
        motion, covariance_, [&load](const Motion&, Load& to) { to = load; }, workspace_);
    addCells(workspace_.motion(), efforts, cells);
  }
  if (of_description) {
    deviations_.computeDescription(motion, workspace_);
    addCells(workspace_.description(), efforts, cells);
  }
  if (of_motion_) violation_ = std::max(violation_, violationOf(results));
  if (doubts_) doubts_->add(results.effort, workspace_, of_motion_, of_description);
}

double DeviationRows::ofEffort(Eigen::Index effort) const {
  const double motion = of_motion_ ? workspace_.motion().effort[effort] : 0;
  const bool of_description = deviations_.hasTolerances();
  const double description = of_description ? workspace_.description().effort[effort] : 0;
  return std::hypot(motion, description);
}

std::string DeviationRows::notes(double threshold) const {
  std::string text;
  if (!exact_.empty()) {
    text = "note: " + printable(path_) + ": deviations take as exact: " + joined(exact_) + "\n";
  }
  if (violation_ > kLoopTolerance) {
    text += "note: " + printable(path_) + ": the motion violates loops by up to " +
            numberText(violation_) +
            " relative, of which deviations know nothing: errors of results may be larger\n";
  }
  if (!doubts_) return text;
  for (const EffortDoubt& doubt : doubts_->above(threshold)) {
    text += "note: " + printable(path_) + ": " + toString(doubt) + "\n";
  }
  return text;
}

}  // namespace virtual_work_dynamics
