#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

namespace {

bool allFinite(const std::vector<Wrench>& wrenches) {
  for (const Wrench& wrench : wrenches) {
    if (!wrench.force.allFinite() || !wrench.torque.allFinite()) return false;
  }
  return true;
}

}  // namespace

bool Results::finite() const {
  for (const Pose& pose : poses) {
    if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) return false;
  }
  for (const Twist& twist : twists) {
    if (!twist.linear.allFinite() || !twist.angular.allFinite()) return false;
  }
  return effort.allFinite() && allFinite(child_axes) && allFinite(root_axes);
}

}  // namespace virtual_work_dynamics
