#include "scene/moment_points.h"

#include <Eigen/Geometry>
#include <string>
#include <unordered_map>

#include "base/printable.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

LinkPoint pointOnLink(const Mechanism& mechanism, const MomentPoint& point,
                      const std::string& place) {
  return {linkNamed(mechanism, *point.link, place + ".link"), point.at.cast<long double>()};
}

LinkPoint pointOfJoint(const Mechanism& mechanism, int index, const MomentPoint& point) {
  const Vector3l at = point.at.cast<long double>();
  if (point.frame == JointFrame::kChild) return {mechanism.joint(index).child_link, at};
  const CompoundJoint* const compound = mechanism.compoundOf(index);
  const Joint& joint = mechanism.joint(compound ? compound->first : index);
  return {joint.parent_link, joint.p_PoKo_P + joint.R_PK * at};
}

LinkPoint pointOfClosure(const Mechanism& mechanism, const Closure& closure,
                         const MomentPoint& point, const std::string& place) {
  using Turn = Eigen::AngleAxis<long double>;
  const LinkFrame& frame = point.frame == JointFrame::kChild ? closure.child : closure.parent;
  const Vector3l rpy = frame.rpy.cast<long double>(), at = point.at.cast<long double>();
  const Vector3l turned =
      Turn(rpy.z(), Vector3l::UnitZ()) *
      (Turn(rpy.y(), Vector3l::UnitY()) * (Turn(rpy.x(), Vector3l::UnitX()) * at));
  return {linkNamed(mechanism, frame.link, place), frame.xyz.cast<long double>() + turned};
}

}  // namespace

MomentPoints::MomentPoints(const Mechanism& mechanism, const Scene& scene) {
  std::unordered_map<std::string, std::size_t> closures;
  for (const Closure& closure : scene.closures) closures.emplace(closure.name, closures.size());
  for (std::size_t i = 0; i < scene.moments_about.size(); ++i) {
    const MomentPoint& point = scene.moments_about[i];
    const std::string place = entryOf("moments_about", i);
    if (point.name == kGround) {
      throw SceneError(place + ": the moment of ground is about the origin of the root link");
    }
    if (!point.at.allFinite()) throw SceneError(place + ".at: is not three finite numbers");
    const int joint = mechanism.reactionIndex(point.name);
    const auto closure = closures.find(point.name);
    if (joint < 0 && closure == closures.end()) {
      failAtUnknown(mechanism, scene, point.name, place);
    }
    const auto resolved = [&] {
      if (point.link) return pointOnLink(mechanism, point, place);
      if (joint >= 0) return pointOfJoint(mechanism, joint, point);
      return pointOfClosure(mechanism, scene.closures[closure->second], point, place);
    }();
    const bool first = joint >= 0 ? joints_.emplace(joint, resolved).second
                                  : closures_.emplace(closure->second, resolved).second;
    if (!first) throw SceneError(place + ": " + inQuotes(point.name) + " is named twice");
  }
}

}  // namespace virtual_work_dynamics
