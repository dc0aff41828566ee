#include "dynamics/contact_gaps.h"

#include "scene/lookup.h"

namespace virtual_work_dynamics {

namespace {

LinkKinematics::Frame gapFrame(const Mechanism& mechanism, const LinkFrame& from, const char* key) {
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(from.rpy.z(), Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(from.rpy.y(), Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(from.rpy.x(), Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  return {linkNamed(mechanism, from.link, key), R, from.xyz};
}

}  // namespace

ContactGaps::ContactGaps(const Mechanism& mechanism, const Scene& scene) : links_(mechanism) {
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    const Closure& closure = scene.closures[c];
    if (!closure.touch.gap) continue;
    contacts_.push_back({c, closure.touch.closed});
    frames_.push_back({gapFrame(mechanism, closure.parent, "plane.link"),
                       gapFrame(mechanism, closure.child, "link"), *closure.touch.gap});
  }
}

bool ContactGaps::take(const Motion& motion) {
  if (contacts_.empty()) return false;
  links_.setOrientations(motion.orientations);
  links_.setPosition(motion.q);
  bool changes = false;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Contact& contact = contacts_[i];
    const Frames& frames = frames_[i];
    contact.distance = links_.axisOf(frames.plane, 2)
                           .dot(links_.originOf(frames.point) - links_.originOf(frames.plane));
    const bool closed = contact.distance <= (contact.closed ? frames.gap.open : frames.gap.close);
    changes = changes || closed != contact.closed;
    contact.closed = closed;
  }
  return changes;
}

}  // namespace virtual_work_dynamics
