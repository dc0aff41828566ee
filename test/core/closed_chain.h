#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "robot_builder.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A random tree closed by joints whose frames meet at a random position, the assembly, so that any
/// type of closure fits. As many joints are actuated as the closures leave degrees of freedom.
class ClosedChain {
 public:
  /// Makes a tree of `joints` joints, some of which slide.
  ClosedChain(unsigned seed, int joints) : builder_(seed), joints_(joints) {
    for (int i = 0; i < joints; ++i) {
      const bool slides = i % 4 == 2;
      const Vector3l axis = builder_.direction();
      const Matrix3l R_PK = builder_.rotation();
      builder_.add(slides ? JointType::kPrismatic : JointType::kRevolute, i, axis, R_PK,
                   builder_.vector(0.4));
    }
    mechanism_.reset(new Mechanism(builder_.build()));
    const Motion start = builder_.motion();
    q_ = start.q;
    scene_.actuated.emplace();
    for (int i = 0; i < joints; ++i) {
      scene_.assembly.push_back({name(i), q_[i]});
      scene_.actuated->push_back(name(i));
    }
  }

  /// Adds a closure between two links. As many of the last actuated joints become passive as it has
  /// conditions.
  void close(ClosureType type, int parent, int child) {
    Request request;
    request.root_axes = {name(child - 1)};
    if (parent > 0) request.root_axes.push_back(name(parent - 1));
    request.poses = true;
    const InverseDynamics tree(*mechanism_, Scene(), request);
    Workspace workspace = tree.makeWorkspace();
    Motion motion(joints_);
    motion.q = q_;
    tree.compute(motion, workspace);
    const Pose child_link = workspace.poses()[0];
    const Pose parent_link = parent > 0 ? workspace.poses()[1] : Pose();
    Closure closure;
    closure.name = "closure_" + std::to_string(scene_.closures.size());
    closure.type = type;
    closure.child.link = "link_" + std::to_string(child);
    closure.child.xyz = builder_.vector(0.3).cast<double>();
    closure.child.rpy = builder_.vector(1.4).cast<double>();
    closure.parent.link = "link_" + std::to_string(parent);
    Eigen::Vector3d at = child_link.position + child_link.orientation * closure.child.xyz;
    if (type == ClosureType::kDistance) at += builder_.vector(0.5).cast<double>();
    closure.parent.xyz = parent_link.orientation.inverse() * (at - parent_link.position);
    const Eigen::Matrix3d R =
        (parent_link.orientation.inverse() * child_link.orientation * rotation(closure.child.rpy))
            .toRotationMatrix();
    closure.parent.rpy << std::atan2(R(2, 1), R(2, 2)),
        std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), std::atan2(R(1, 0), R(0, 0));
    scene_.closures.push_back(closure);
    static const int kConditions[] = {6, 5, 5, 4, 4, 3, 3, 1};
    scene_.actuated->resize(scene_.actuated->size() -
                            static_cast<std::size_t>(kConditions[static_cast<int>(type)]));
  }

  const Mechanism& mechanism() const { return *mechanism_; }
  Scene& scene() { return scene_; }
  RobotBuilder& builder() { return builder_; }
  const Eigen::VectorXd& position() const { return q_; }

 private:
  static std::string name(int joint) { return "joint_" + std::to_string(joint + 1); }
  static Eigen::Quaterniond rotation(const Eigen::Vector3d& rpy) {
    using Turn = Eigen::AngleAxisd;
    return Turn(rpy.z(), Eigen::Vector3d::UnitZ()) * Turn(rpy.y(), Eigen::Vector3d::UnitY()) *
           Turn(rpy.x(), Eigen::Vector3d::UnitX());
  }

  RobotBuilder builder_;
  int joints_;
  std::unique_ptr<Mechanism> mechanism_;
  Eigen::VectorXd q_;
  Scene scene_;
};

}  // namespace virtual_work_dynamics
