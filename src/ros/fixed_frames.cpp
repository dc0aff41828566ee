#include "ros/fixed_frames.h"

#include <vector>

#include "base/nearest_name.h"
#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

// Pose of a link in the link that it hangs on by fixed joints, and that moves or is the root.
struct Hung {
  int on;
  Matrix3l R = Matrix3l::Identity();
  Vector3l origin = Vector3l::Zero();
};

Hung hung(const Mechanism& mechanism, int link) {
  Hung pose{link};
  while (mechanism.link(pose.on).parent_joint >= 0) {
    const Joint& joint = mechanism.joint(mechanism.link(pose.on).parent_joint);
    if (joint.type != JointType::kFixed) break;
    pose.origin = joint.p_PoKo_P + joint.R_PK * pose.origin;
    pose.R = joint.R_PK * pose.R;
    pose.on = joint.parent_link;
  }
  return pose;
}

Rejection unknownFrame(const std::string& text) {
  return Rejection{DropReason::kUnknownFrame, text};
}

// The link that a frame_id names; refuses others.
std::optional<Rejection> findLink(const Mechanism& mechanism, const std::string& prefix,
                                  const std::string& id, int& other) {
  const bool prefixed = id.compare(0, prefix.size(), prefix) == 0;
  other = prefixed ? mechanism.linkIndex(id.substr(prefix.size())) : -1;
  if (other >= 0) return std::nullopt;
  std::vector<std::string> names;
  for (const Link& known : mechanism.links()) names.push_back(known.name);
  return unknownFrame("its frame " + inQuotes(id) + " is not " +
                      (prefix.empty() ? "" : inQuotes(prefix) + " and ") + "a link of robot " +
                      inQuotes(mechanism.name()) + nameHelp(id, names));
}

}  // namespace

std::optional<Rejection> findFixedFrame(const Mechanism& mechanism, const std::string& prefix,
                                        const std::string& id, int link, FixedFrame& frame) {
  int other = -1;
  if (auto rejection = findLink(mechanism, prefix, id, other)) return rejection;
  const Hung of_frame = hung(mechanism, other), of_link = hung(mechanism, link);
  if (of_frame.on != of_link.on) {
    const int moving = of_frame.on == 0 ? of_link.on : of_frame.on;
    return unknownFrame(
        "its frame " + inQuotes(id) + " moves against " +
        (link == 0 ? "the root link" : "link " + inQuotes(mechanism.link(link).name)) +
        ", by joint " + inQuotes(mechanism.joint(mechanism.link(moving).parent_joint).name));
  }
  const Matrix3l to_link = of_link.R.transpose();
  frame.R = (to_link * of_frame.R).cast<double>();
  frame.origin = (to_link * (of_frame.origin - of_link.origin)).cast<double>();
  return std::nullopt;
}

std::optional<Rejection> findCarryingLink(const Mechanism& mechanism, const std::string& prefix,
                                          const std::string& id, int& link, FixedFrame& frame) {
  int other = -1;
  if (auto rejection = findLink(mechanism, prefix, id, other)) return rejection;
  const Hung of_frame = hung(mechanism, other);
  link = of_frame.on;
  frame.R = of_frame.R.cast<double>();
  frame.origin = of_frame.origin.cast<double>();
  return std::nullopt;
}

}  // namespace virtual_work_dynamics
