#include "loops/condition_sizes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace virtual_work_dynamics {

namespace {

// Least extent of a loop that counts, as a fraction of the length: what lies closer together may do
// so by rounding errors of positions only.
constexpr double kLeastExtent = 1e-4;

// The largest distance between these origins and those of joints on a path.
double extentOf(const LoopKinematics& kinematics, const std::vector<PathStep>& path,
                std::vector<Eigen::Vector3d> origins) {
  for (const PathStep& step : path) origins.push_back(kinematics.originOf(step.joint + 1));
  double extent = 0;
  for (const Eigen::Vector3d& a : origins) {
    for (const Eigen::Vector3d& b : origins) extent = std::max(extent, (a - b).norm());
  }
  return extent;
}

}  // namespace

ConditionSizes::ConditionSizes(const Mechanism& mechanism, const LoopKinematics& kinematics,
                               const LoopGroup& group, double length) {
  for (const std::size_t closure : group.closures) {
    const std::vector<PathStep>& path = kinematics.path(closure);
    sizes_.push_back(
        sizesOf(mechanism, path,
                extentOf(kinematics, path,
                         {kinematics.parentOrigin(closure), kinematics.childOrigin(closure)}),
                length));
  }
  for (std::size_t local = sizes_.size(); local < group.sets.size(); ++local) {
    const std::vector<PathStep>* path = kinematics.set(group.sets[local]).levers();
    sizes_.push_back(path ? sizesOf(mechanism, *path, extentOf(kinematics, *path, {}), length)
                          : Sizes{0, 0});
  }
}

ConditionSizes::Sizes ConditionSizes::sizesOf(const Mechanism& mechanism,
                                              const std::vector<PathStep>& path, double extent,
                                              double length) {
  const double lever = std::max(extent / length, kLeastExtent);
  Sizes sizes{0, 0};
  std::map<int, Sizes> by_coordinate;
  for (const PathStep& step : path) {
    const Joint& joint = mechanism.joint(step.joint);
    if (joint.coordinate < 0) continue;
    const bool slides = unitOf(joint) == Unit::kMetre;
    // A mimic of the other kind multiplies by a length.
    const double ratio = std::abs(static_cast<double>(joint.multiplier)) *
                         scaleOf(mechanism.unitOf(joint.coordinate), length) /
                         scaleOf(unitOf(joint), length);
    Sizes& levers = by_coordinate.emplace(joint.coordinate, Sizes{0, 0}).first->second;
    levers.force += ratio * (slides ? 1 : lever);
    levers.moment += ratio * (slides ? 0 : 1);
  }
  for (const auto& entry : by_coordinate) {
    sizes.force = std::hypot(sizes.force, entry.second.force);
    sizes.moment = std::hypot(sizes.moment, entry.second.moment);
  }
  return sizes;
}

double ConditionSizes::ofRow(std::size_t local, Unit unit) const {
  if (local >= sizes_.size()) return 0;
  return unit == Unit::kMetre ? sizes_[local].force : sizes_[local].moment;
}

}  // namespace virtual_work_dynamics
