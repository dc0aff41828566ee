#include "offline/deviation_rows.h"

#include <cmath>

#include "dynamics/sample_rows.h"
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

}  // namespace

DeviationRows::DeviationRows(const Mechanism& mechanism, const Scene& scene, const Request& request,
                             const MotionTable& table, const std::string& path)
    : table_(table),
      path_(path),
      of_motion_(table.hasCovariances()),
      deviations_(mechanism, scene, request),
      workspace_(deviations_.makeWorkspace()) {
  if (!of_motion_ && !deviations_.hasTolerances()) {
    throw Error(path +
                ": --deviations: the error of this motion is not known, as nothing of it is "
                "estimated, and the scene has no tolerances");
  }
  covariance_.coordinates.resize(table.joints.size());
  if (request.efforts) {
    doubts_.emplace(deviations_.effortNames(), deviations_.residuals(),
                    mechanism.coordinateNames());
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
    takeCovariance(table_, row, covariance_);
    deviations_.computeMotion(
        motion, covariance_, [&load](const Eigen::VectorXd&, Load& to) { to = load; }, workspace_);
    addCells(workspace_.motion(), efforts, cells);
  }
  if (of_description) {
    deviations_.computeDescription(motion, workspace_);
    addCells(workspace_.description(), efforts, cells);
  }
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
  if (!doubts_) return text;
  for (const EffortDoubt& doubt : doubts_->above(threshold)) {
    text += "note: " + path_ + ": " + toString(doubt) + "\n";
  }
  return text;
}

}  // namespace virtual_work_dynamics
