#include "virtual_work_dynamics/motion_fit.h"

#include <string>

#include "loops/given_loops.h"
#include "loops/loop_fit.h"
#include "scene/input_checks.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

constexpr double MotionFit::kMost;

MotionFit::MotionFit(const Mechanism& mechanism, const Dynamics& dynamics)
    : coordinates_(dynamics.coordinates()) {
  if (dynamics.closureNames().empty() || dynamics.orientations() > 0) return;
  if (dynamics.given().drivenNumbers() > 0) return;
  Given all;
  all.coordinates.assign(static_cast<std::size_t>(dynamics.coordinates()), true);
  const std::unique_ptr<GivenLoops> loops = dynamics.givenLoops(all);
  loops_ = std::make_unique<LoopFit>(mechanism, loops->kinematics(), loops->length(), kMost);
}

MotionFit::~MotionFit() = default;
MotionFit::MotionFit(MotionFit&&) noexcept = default;
MotionFit& MotionFit::operator=(MotionFit&&) noexcept = default;

bool MotionFit::fit(Motion& motion, const MotionCovariance& covariance, bool rates) {
  if (!any()) return true;
  requireLengths(motion, coordinates_);
  if (static_cast<Eigen::Index>(covariance.coordinates.size()) != coordinates_) {
    throw MotionError("motion: there are covariances of " +
                      std::to_string(covariance.coordinates.size()) + " coordinates, expected " +
                      std::to_string(coordinates_));
  }
  const bool explained = loops_->fit(motion, covariance, rates);
  const LoopFit::Farthest& found = loops_->farthest();
  farthest_ = {found.deviations, found.coordinate, found.level};
  return explained;
}

}  // namespace virtual_work_dynamics
