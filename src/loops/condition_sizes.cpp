#include "loops/condition_sizes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace virtual_work_dynamics {

namespace {

// Least lever of a row, as a fraction of the length: times the default tolerance of the rank it is
// some ten rounding errors of positions.
constexpr double kLeastLever = 1e-4;

// The largest distance between origins.
double extentOf(const std::vector<Eigen::Vector3d>& origins) {
  double extent = 0;
  for (const Eigen::Vector3d& a : origins) {
    for (const Eigen::Vector3d& b : origins) extent = std::max(extent, (a - b).norm());
  }
  return extent;
}

// The lever of a row that misses none of a loop's axes, over the length.
double leverOf(double extent, double length, double tolerance) {
  const double lever = extent / length;
  return lever > tolerance ? std::max(lever, kLeastLever) : 1;
}

}  // namespace

ConditionSizes::ConditionSizes(const Mechanism& mechanism, const LoopKinematics& kinematics,
                               const LoopGroup& group, double length, double tolerance) {
  const auto add = [&](const std::vector<PathStep>& path,
                       const std::vector<Eigen::Vector3d>& origins) {
    const double extent = extentOf(origins);
    sizes_.push_back(sizesOf(mechanism, path, leverOf(extent, length, tolerance), length));
  };
  for (const std::size_t closure : group.closures) {
    const std::vector<PathStep>& path = kinematics.path(closure);
    std::vector<Eigen::Vector3d> origins{kinematics.parentEnd(closure),
                                         kinematics.childOrigin(closure)};
    for (const PathStep& step : path) {
      if (!kinematics.sizes(closure, step.joint)) continue;
      origins.push_back(kinematics.originOf(step.joint + 1));
    }
    add(path, origins);
  }
  for (std::size_t local = sizes_.size(); local < group.sets.size(); ++local) {
    if (const std::vector<PathStep>* path = kinematics.set(group.sets[local]).levers()) {
      std::vector<Eigen::Vector3d> origins;
      for (const PathStep& step : *path) origins.push_back(kinematics.originOf(step.joint + 1));
      add(*path, origins);
    } else {
      sizes_.push_back({0, 0});
    }
  }
}

ConditionSizes::Sizes ConditionSizes::sizesOf(const Mechanism& mechanism,
                                              const std::vector<PathStep>& path, double lever,
                                              double length) {
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
