#include "loops/condition_sizes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace virtual_work_dynamics {

namespace {

// Least extent of a loop that counts, as a fraction of the length: what lies closer together may do
// so by rounding errors of positions only.
constexpr double kLeastExtent = 1e-4;

// The largest distance between two origins of joints and closure frames on a loop.
double extentOf(const LoopKinematics& kinematics, std::size_t closure) {
  std::vector<Eigen::Vector3d> origins{kinematics.parentOrigin(closure),
                                       kinematics.childOrigin(closure)};
  for (const PathStep& step : kinematics.path(closure)) {
    origins.push_back(kinematics.originOf(step.joint + 1));
  }
  double extent = 0;
  for (const Eigen::Vector3d& a : origins) {
    for (const Eigen::Vector3d& b : origins) extent = std::max(extent, (a - b).norm());
  }
  return extent;
}

}  // namespace

ConditionSizes::ConditionSizes(const Mechanism& mechanism, const LoopKinematics& kinematics,
                               const LoopGroup& group, double length) {
  struct Levers {
    double force = 0, moment = 0;
  };
  for (const std::size_t closure : group.closures) {
    const double lever = std::max(extentOf(kinematics, closure) / length, kLeastExtent);
    std::map<int, Levers> by_coordinate;
    for (const PathStep& step : kinematics.path(closure)) {
      const Joint& joint = mechanism.joint(step.joint);
      if (joint.coordinate < 0) continue;
      const bool slides = unitOf(joint) == Unit::kMetre;
      // A mimic of the other kind multiplies by a length.
      const double ratio = std::abs(static_cast<double>(joint.multiplier)) *
                           scaleOf(mechanism.unitOf(joint.coordinate), length) /
                           scaleOf(unitOf(joint), length);
      Levers& levers = by_coordinate[joint.coordinate];
      levers.force += ratio * (slides ? 1 : lever);
      levers.moment += ratio * (slides ? 0 : 1);
    }
    Sizes sizes{0, 0};
    for (const auto& entry : by_coordinate) {
      sizes.force = std::hypot(sizes.force, entry.second.force);
      sizes.moment = std::hypot(sizes.moment, entry.second.moment);
    }
    sizes_.push_back(sizes);
  }
}

double ConditionSizes::ofRow(std::size_t local, Unit unit) const {
  if (local >= sizes_.size()) return 0;
  return unit == Unit::kMetre ? sizes_[local].force : sizes_[local].moment;
}

}  // namespace virtual_work_dynamics
