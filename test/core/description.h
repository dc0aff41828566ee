#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A tree of links for tests that change it. Links and joints have any order, the `parent_joint` of
/// links has no meaning, and the `coordinate` of a mimic joint is the index of its master in
/// `joints`.
struct Description {
  std::vector<Link> links;
  std::vector<Joint> joints;

  Description() = default;
  explicit Description(const Mechanism& mechanism)
      : links(mechanism.links()), joints(mechanism.joints()) {
    for (Joint& joint : joints) {
      if (joint.mimics) joint.coordinate = mechanism.coordinates()[joint.coordinate];
    }
  }

  /// The joint that carries a link; nullptr for the root.
  Joint* carrierOf(int link) {
    const auto found = std::find_if(joints.begin(), joints.end(),
                                    [&](const Joint& joint) { return joint.child_link == link; });
    return found == joints.end() ? nullptr : &*found;
  }

  /// Makes the Mechanism, in its order: depth first, children by joint name.
  Mechanism arranged() const {
    std::vector<Link> ordered_links;
    std::vector<Joint> ordered_joints;
    std::vector<int> place(joints.size(), -1);               // of each joint in the new order
    std::vector<std::pair<int, int>> pending{{-1, root()}};  // joint, its child link
    while (!pending.empty()) {
      const auto [joint, link] = pending.back();
      pending.pop_back();
      const int new_link = static_cast<int>(ordered_links.size());
      ordered_links.push_back(links[link]);
      ordered_links.back().parent_joint = new_link - 1;
      if (joint >= 0) {
        place[joint] = new_link - 1;
        ordered_joints.push_back(joints[joint]);
        ordered_joints.back().child_link = new_link;
      }
      for (const int child : childrenLastNameFirst(link)) {
        pending.emplace_back(child, joints[child].child_link);
      }
    }
    for (Joint& joint : ordered_joints) {
      const Joint* carrier = carrierIn(joints, joint.parent_link);
      joint.parent_link = carrier ? place[carrier - joints.data()] + 1 : 0;
    }
    number(ordered_joints, place);
    return Mechanism("changed", std::move(ordered_links), std::move(ordered_joints));
  }

 private:
  static const Joint* carrierIn(const std::vector<Joint>& joints, int link) {
    for (const Joint& joint : joints) {
      if (joint.child_link == link) return &joint;
    }
    return nullptr;
  }

  int root() const {
    int link = 0;
    while (carrierIn(joints, link)) ++link;
    return link;
  }

  std::vector<int> childrenLastNameFirst(int link) const {
    std::vector<int> children;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      if (joints[k].parent_link == link) children.push_back(static_cast<int>(k));
    }
    std::sort(children.begin(), children.end(),
              [&](int a, int b) { return joints[a].name > joints[b].name; });
    return children;
  }

  static void number(std::vector<Joint>& ordered, const std::vector<int>& place) {
    int coordinates = 0;
    for (Joint& joint : ordered) {
      if (joint.type != JointType::kFixed && !joint.mimics) joint.coordinate = coordinates++;
    }
    for (Joint& joint : ordered) {
      if (joint.mimics) joint.coordinate = ordered[place[joint.coordinate]].coordinate;
    }
  }
};

/// Moves a link's frame to the pose (p, R) in its present frame. The link's centre of mass and
/// inertia, the joints that hang on it and the wrenches that act on it stay where they are in
/// space; the caller adapts the joint that carries it.
inline void moveFrame(Description& description, Scene& scene, int link, const Vector3l& p,
                      const Matrix3l& R) {
  Link& body = description.links[link];
  body.p_KoCm_K = R.transpose() * (body.p_KoCm_K - p);
  body.inertia_Cm_K = R.transpose() * body.inertia_Cm_K * R;
  for (Joint& joint : description.joints) {
    if (joint.parent_link != link) continue;
    joint.p_PoKo_P = R.transpose() * (joint.p_PoKo_P - p);
    joint.R_PK = R.transpose() * joint.R_PK;
  }
  for (AppliedWrench& applied : scene.applied_wrenches) {
    if (applied.link != body.name) continue;
    applied.at = (R.transpose() * (applied.at.cast<long double>() - p)).cast<double>();
    if (applied.axes == Axes::kRoot) continue;
    applied.force = (R.transpose() * applied.force.cast<long double>()).cast<double>();
    applied.torque = (R.transpose() * applied.torque.cast<long double>()).cast<double>();
  }
}

/// Expresses the vectors that a scene gives in root axes in other axes: R turns the old components
/// into the new ones.
inline void turnRootAxes(Scene& scene, const Matrix3l& R) {
  const auto turn = [&](Eigen::Vector3d& v) { v = (R * v.cast<long double>()).cast<double>(); };
  turn(scene.gravity);
  for (AppliedWrench& applied : scene.applied_wrenches) {
    if (applied.axes != Axes::kRoot) continue;
    turn(applied.force);
    turn(applied.torque);
  }
}

}  // namespace virtual_work_dynamics
