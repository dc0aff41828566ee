#include "dynamics/live_wrenches.h"

#include <algorithm>
#include <cmath>

#include "base/cross_matrix.h"
#include "scene/input_checks.h"

namespace virtual_work_dynamics {

LiveWrenches::LiveWrenches(const Mechanism& mechanism, const Scene& scene, double timeout)
    : links_(mechanism) {
  const auto timeout_ns = static_cast<std::int64_t>(std::llround(timeout * 1e9));
  for (std::size_t i = 0; i < scene.applied_wrenches.size(); ++i) {
    const AppliedWrench& wrench = scene.applied_wrenches[i];
    if (!wrench.live) continue;
    wrenches_.push_back({wrench.name,
                         i,
                         linkOf(mechanism, scene, i),
                         wrench.invert ? -1.0 : 1.0,
                         wrench.deviation.value_or(WrenchDeviation()),
                         WrenchHistory(timeout_ns),
                         {}});
  }
}

std::optional<std::size_t> LiveWrenches::read(std::int64_t stamp_ns) {
  std::optional<std::size_t> unknown;
  for (std::size_t i = wrenches_.size(); i-- > 0;) {
    wrenches_[i].reading = wrenches_[i].history.read(stamp_ns);
    if (!wrenches_[i].reading.before) unknown = i;
  }
  return unknown;
}

bool LiveWrenches::anyHeld() const {
  return std::any_of(wrenches_.begin(), wrenches_.end(),
                     [](const Live& live) { return live.reading.held; });
}

void LiveWrenches::getLoad(const Motion& motion, Load& load) {
  if (movesFrames()) {
    links_.setOrientations(motion.orientations);
    links_.setPosition(motion.q);
    root_ = motion.root;
  }
  for (const Live& live : wrenches_) {
    const WrenchHistory::Reading& reading = live.reading;
    Wrench& wrench = load.wrenches[live.applied];
    wrench = onLink(live, *reading.before);
    if (reading.after) {
      const Wrench after = onLink(live, *reading.after);
      wrench.force += reading.share * (after.force - wrench.force);
      wrench.torque += reading.share * (after.torque - wrench.torque);
    }
    wrench.force *= live.sign;
    wrench.torque *= live.sign;
  }
}

// Whether a wrench was measured in the frame of another link than it acts on.
bool LiveWrenches::movesFrames() const {
  return std::any_of(wrenches_.begin(), wrenches_.end(), [](const Live& live) {
    const WrenchHistory::Reading& reading = live.reading;
    return reading.before->frame != live.link ||
           (reading.after && reading.after->frame != live.link);
  });
}

LiveWrenches::Placed LiveWrenches::frameOf(const Live& live, const MeasuredWrench& measured) const {
  if (measured.frame == live.link) return {Eigen::Matrix3d::Identity(), measured.at};
  const Eigen::Matrix3d R_L0 = links_.axesOf(live.link).transpose();
  Eigen::Matrix3d R_0F;
  Eigen::Vector3d origin;
  if (measured.frame == MeasuredWrench::kInertial) {
    R_0F = root_.orientation.conjugate().toRotationMatrix();
    origin = -(R_0F * root_.position);
  } else {
    R_0F = links_.axesOf(measured.frame);
    origin = links_.originOf(measured.frame);
  }
  return {R_L0 * R_0F, R_L0 * (origin + R_0F * measured.at - links_.originOf(live.link))};
}

// The wrench in the axes of the link that it acts on, with the moment about that link's origin.
Wrench LiveWrenches::onLink(const Live& live, const MeasuredWrench& measured) const {
  if (measured.frame == live.link && measured.at.isZero(0)) return measured.value;
  const Placed frame = frameOf(live, measured);
  const Eigen::Vector3d force = frame.R_LF * measured.value.force;
  return {force, frame.R_LF * measured.value.torque + frame.p_LoFo_L.cross(force)};
}

// Turned alike about all axes, a sensor's deviations stay; its force turns about the link's origin.
WrenchCovariance LiveWrenches::covarianceOf(const Live& live,
                                            const MeasuredWrench& measured) const {
  const double force = live.deviation.force * live.deviation.force;
  const double torque = live.deviation.torque * live.deviation.torque;
  WrenchCovariance covariance = WrenchCovariance::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(force), Eigen::Vector3d::Constant(torque);
  if (measured.frame == live.link && measured.at.isZero(0)) return covariance;
  const Eigen::Matrix3d lever = crossMatrix(frameOf(live, measured).p_LoFo_L);
  covariance.bottomRightCorner<3, 3>() += force * lever * lever.transpose();
  covariance.bottomLeftCorner<3, 3>() = force * lever;
  covariance.topRightCorner<3, 3>() = force * lever.transpose();
  return covariance;
}

void LiveWrenches::getCovariances(std::vector<WrenchCovariance>& covariances) const {
  for (const Live& live : wrenches_) {
    const WrenchHistory::Reading& reading = live.reading;
    const double after = reading.share, before = 1 - after;
    WrenchCovariance& covariance = covariances[live.applied];
    covariance = before * before * covarianceOf(live, *reading.before);
    if (reading.after) covariance += after * after * covarianceOf(live, *reading.after);
  }
}

}  // namespace virtual_work_dynamics
