#include "loops/unknowns.h"

#include <algorithm>
#include <cmath>

#include "loops/zero_rows.h"

namespace virtual_work_dynamics {

LoopUnknowns::LoopUnknowns(const Mechanism& mechanism, const LoopKinematics& kinematics,
                           const LoopScene& scene, const LoopGroup& group, double length) {
  for (std::size_t row = 0; row < group.coordinates.size(); ++row) {
    const std::size_t i = static_cast<std::size_t>(group.coordinates[row]);
    row_units.push_back(effortScaleOf(mechanism.unitOf(group.coordinates[row]), length));
    if (!scene.actuated[i]) continue;
    effort_rows.push_back(static_cast<int>(row));
    efforts.push_back({i, row_units.back() / std::sqrt(scene.coordinate_weights[i]), count++});
  }
  for (std::size_t local = 0; local < group.sets.size(); ++local) {
    const std::size_t s = group.sets[local];
    OfSet own{s, count, {}, -1, group.moved[local]};
    for (Eigen::Index i = kinematics.firstOf(s); i < kinematics.firstOf(s + 1); ++i) {
      own.columns.push_back({i, effortScaleOf(kinematics.condition(i).unit, length)});
    }
    const auto& actuated = scene.actuated_closures;  // closure c is set c
    const auto found = std::find(actuated.begin(), actuated.end(), s);
    if (found != actuated.end()) {
      const double unit = effortScaleOf(kinematics.closure(s).freeUnit(), length) /
                          std::sqrt(scene.closure_weights[s]);
      own.effort = static_cast<int>(efforts.size());
      const std::size_t place = static_cast<std::size_t>(found - actuated.begin());
      efforts.push_back({scene.actuated.size() + place, unit,
                         count + static_cast<Eigen::Index>(own.columns.size())});
      own.columns.push_back({-1, unit});
    }
    count += static_cast<Eigen::Index>(own.columns.size());
    of_sets.push_back(own);
  }
}

std::vector<RowBlock> LoopUnknowns::rowBlocks(const Mechanism& mechanism,
                                              const LoopKinematics& kinematics) const {
  const std::vector<bool> zero = zeroRows(mechanism, kinematics);
  std::vector<RowBlock> blocks;
  for (const int row : effort_rows) blocks.push_back({1, {row}, {}});
  for (const OfSet& own : of_sets) {
    blocks.push_back({static_cast<Eigen::Index>(own.columns.size()), own.coordinates,
                      zeroRowsOf(kinematics, own.set, zero)});
  }
  return blocks;
}

}  // namespace virtual_work_dynamics
