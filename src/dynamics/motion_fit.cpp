#include "virtual_work_dynamics/motion_fit.h"

#include <algorithm>
#include <string>

#include "loops/given_loops.h"
#include "loops/loop_fit.h"
#include "scene/input_checks.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

void requireCount(const char* what, Eigen::Index count, Eigen::Index expected) {
  if (count == expected) return;
  throw MotionError(std::string("motion: there are ") + what + " of " + std::to_string(count) +
                    " coordinates, expected " + std::to_string(expected));
}

}  // namespace

constexpr double MotionFit::kMost;
constexpr double MotionFit::kNearlyClosed;

MotionFit::MotionFit(const Mechanism& mechanism, const Dynamics& dynamics, double tolerance)
    : coordinates_(dynamics.coordinates()), tolerance_(tolerance) {
  if (dynamics.closureNames().empty() || dynamics.orientations() > 0) return;
  if (dynamics.given().drivenNumbers() > 0) return;
  Given all;
  all.coordinates.assign(static_cast<std::size_t>(dynamics.coordinates()), true);
  const std::unique_ptr<GivenLoops> loops = dynamics.givenLoops(all);
  if (loops->kinematics().conditions() == 0) return;  // cables, and contacts that are open
  loops_ = std::make_unique<LoopFit>(mechanism, loops->kinematics(), loops->length(), tolerance);
  outcome_.wheels = loops_->hasRatesAlone();
}

MotionFit::~MotionFit() = default;
MotionFit::MotionFit(MotionFit&&) noexcept = default;
MotionFit& MotionFit::operator=(MotionFit&&) noexcept = default;

const MotionFit::Outcome& MotionFit::fit(Motion& motion, const MotionCovariance* covariance,
                                         const Eigen::VectorXd& noise, bool rates) {
  if (!any()) return outcome_;
  requireLengths(motion, coordinates_);
  if (covariance) {
    requireCount("covariances", static_cast<Eigen::Index>(covariance->coordinates.size()),
                 coordinates_);
  }
  if (noise.size() > 0) requireCount("noises", noise.size(), coordinates_);
  outcome_.closed =
      loops_->fit(motion, covariance, noise, rates, std::max(kNearlyClosed, tolerance_));
  const LoopFit::Farthest& found = loops_->farthest();
  outcome_.explained = found.deviations <= kMost;
  outcome_.position_rms = loops_->rms(0);
  outcome_.velocity_rms = loops_->rms(1);
  outcome_.farthest = {found.deviations, found.coordinate, found.level, found.amount};
  return outcome_;
}

}  // namespace virtual_work_dynamics
