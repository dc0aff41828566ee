#include "offline/row_loads.h"

#include <algorithm>
#include <string>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "motion/wrench_columns.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

Names namesOf(const Scene& scene) {
  Names names;
  for (const AppliedWrench& wrench : scene.applied_wrenches) {
    if (!wrench.name.empty()) names.push_back(wrench.name);
  }
  return names;
}

void requireLive(const Scene& scene, const MotionFile& file) {
  const Names& given = file.table.wrenches;
  for (const AppliedWrench& wrench : scene.applied_wrenches) {
    if (!wrench.live || std::find(given.begin(), given.end(), wrench.name) != given.end()) continue;
    throw FileError(file.path + ": column " + inQuotes(wrenchColumn(wrench.name, "fx")) +
                    " is missing: the applied wrench " + inQuotes(wrench.name) + " is live");
  }
}

}  // namespace

RowLoads::RowLoads(const Scene& scene, const MotionFile& file)
    : values_(file.table.wrench_values), own_(scene) {
  for (const std::string& name : file.table.wrenches) {
    const auto found =
        std::find_if(scene.applied_wrenches.begin(), scene.applied_wrenches.end(),
                     [&](const AppliedWrench& wrench) { return wrench.name == name; });
    if (found == scene.applied_wrenches.end()) {
      throw FileError(file.path + ": column " + inQuotes(wrenchColumn(name, "fx")) +
                      ": the scene has no applied wrench " + inQuotes(name) +
                      nameHelp(name, namesOf(scene)));
    }
    wrenches_.push_back({static_cast<std::size_t>(found - scene.applied_wrenches.begin()),
                         found->invert ? -1.0 : 1.0});
  }
  requireLive(scene, file);
}

void RowLoads::get(std::size_t row, Load& load) const {
  load.wrenches = own_.wrenches;
  const auto at = static_cast<Eigen::Index>(row);
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    Wrench& wrench = load.wrenches[wrenches_[i].wrench];
    const auto first = static_cast<Eigen::Index>(6 * i);
    wrench.force = wrenches_[i].sign * values_.block<1, 3>(at, first).transpose();
    wrench.torque = wrenches_[i].sign * values_.block<1, 3>(at, first + 3).transpose();
  }
}

}  // namespace virtual_work_dynamics
