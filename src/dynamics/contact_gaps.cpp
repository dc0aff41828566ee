#include "dynamics/contact_gaps.h"

#include <cmath>

#include "scene/lookup.h"

namespace virtual_work_dynamics {

namespace {

// What stays within this share of what lies between closing and opening, for so many samples,
// stands; noise of more than that is not waited for any longer than so.
constexpr double kStands = 0.02;
constexpr int kStandingSamples = 10, kMostLandingSamples = 100;
// Heights that differ by less are the same.
constexpr double kSameHeight = 1e-9;  // m

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
  landings_.resize(contacts_.size());
}

// Has the surface be where the point is, until that stands. Returns whether it moves.
bool ContactGaps::land(std::size_t i) {
  Contact& contact = contacts_[i];
  Landing& landing = landings_[i];
  if (landing.stays >= kStandingSamples || landing.all >= kMostLandingSamples) return false;
  const Gap& gap = frames_[i].gap;
  const bool stays = std::abs(contact.distance - landing.about) <= kStands * (gap.open - gap.close);
  if (!stays) landing.about = contact.distance;
  landing.stays = stays ? landing.stays + 1 : 0;
  ++landing.all;
  if (std::abs(contact.distance - contact.height) <= kSameHeight) return false;
  contact.height = contact.distance;
  return true;
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
    if (closed != contact.closed) landings_[i] = Landing();
    const bool moves = closed && land(i);
    changes = changes || closed != contact.closed || moves;
    contact.closed = closed;
  }
  return changes;
}

}  // namespace virtual_work_dynamics
