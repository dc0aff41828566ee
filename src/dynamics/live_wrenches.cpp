#include "dynamics/live_wrenches.h"

#include <algorithm>
#include <cmath>

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

void LiveWrenches::getLoad(const Eigen::VectorXd& q, Load& load) {
  if (movesFrames()) links_.setPosition(q);
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

// The wrench in the axes of the link that it acts on, with the moment about that link's origin.
Wrench LiveWrenches::onLink(const Live& live, const MeasuredWrench& measured) const {
  if (measured.frame == live.link) return measured.value;
  const Eigen::Matrix3d R_L0 = links_.axesOf(live.link).transpose();
  const Eigen::Matrix3d R_LF = R_L0 * links_.axesOf(measured.frame);
  const Eigen::Vector3d p_LoFo_L =
      R_L0 * (links_.originOf(measured.frame) - links_.originOf(live.link));
  const Eigen::Vector3d force = R_LF * measured.value.force;
  return {force, R_LF * measured.value.torque + p_LoFo_L.cross(force)};
}

}  // namespace virtual_work_dynamics
