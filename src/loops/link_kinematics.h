#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "loops/closure_wrench.h"
#include "loops/kernel/loop_kernel.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// A joint on the path between two links.
struct PathStep {
  int joint;
  double sign;  ///< 1: moves the second of the two links, -1: the first
};

/// Poses and motions of all links of the tree, in root axes. What joint types mean to closed loops
/// is written here. Nothing after construction allocates.
class LinkKinematics {
 public:
  explicit LinkKinematics(const Mechanism& mechanism);

  void setPosition(const Eigen::VectorXd& q);
  /// Computes motions of the links at the present position, with accelerations for qdd = 0.
  void setVelocity(const Eigen::VectorXd& qd);

  const Eigen::Matrix3d& axesOf(int link) const { return links_[static_cast<std::size_t>(link)].R; }
  const Eigen::Vector3d& originOf(int link) const {
    return links_[static_cast<std::size_t>(link)].o;
  }
  /// Axis of a joint; zero for fixed ones.
  const Eigen::Vector3d& axisOf(int joint) const {
    return links_[static_cast<std::size_t>(joint) + 1].z;
  }

  /// A frame F that is fixed on a link.
  struct Frame {
    int link = 0;
    Eigen::Matrix3d R_LF;
    Eigen::Vector3d p_LoFo_L;
  };
  Eigen::Vector3d originOf(const Frame& frame) const {
    return originOf(frame.link) + axesOf(frame.link) * frame.p_LoFo_L;
  }
  /// Axis i of a frame: 0 for x, 1 for y or 2 for z.
  Eigen::Vector3d axisOf(const Frame& frame, int i) const {
    return axesOf(frame.link) * frame.R_LF.col(i);
  }
  Eigen::Matrix3d axesOf(const Frame& frame) const { return axesOf(frame.link) * frame.R_LF; }
  /// How a link moves at one of its points: m/s, rad/s, m/s^2, rad/s^2, accelerations for qdd = 0.
  struct PointMotion {
    Eigen::Vector3d v, w, a, alpha;
  };
  PointMotion motionAt(int link, const Eigen::Vector3d& point) const;

  /// The coordinate that moves a joint; -1 when it is fixed.
  int coordinateOf(const PathStep& step) const {
    return joints_[static_cast<std::size_t>(step.joint)].coordinate;
  }
  /// How a step of a joint displaces the second link relative to the first: by a unit angle, or by
  /// a slide of `length`.
  struct Displacement {
    Eigen::Vector3d turn, origin;  ///< rad; of a point on the second link, m
  };
  Displacement displacementBy(const PathStep& step, const Eigen::Vector3d& at, double length) const;

  /// How the coordinate that moves the joint moves the second link relative to the first: per unit
  /// of the coordinate, the turn and the displacement of a point of the second link.
  Displacement movedBy(const PathStep& step, const Eigen::Vector3d& at) const {
    const JointShape& joint = joints_[static_cast<std::size_t>(step.joint)];
    const LinkState& link = links_[static_cast<std::size_t>(step.joint) + 1];
    const Eigen::Vector3d along = step.sign * joint.multiplier * link.z;
    if (joint.kind == JointKind::kSlides) return {Eigen::Vector3d::Zero(), along};
    return {along, along.cross(at - link.o)};
  }

  /// As kernels see the joints, and the numbers of the links.
  LinksView view() const {
    return {joints_.data(), angles_.data(), static_cast<int>(joints_.size()),
            static_cast<int>(angles_.size())};
  }
  const double* numbers() const { return links_.front().R.data(); }
  double* numbers() { return links_.front().R.data(); }
  std::size_t count() const { return links_.size(); }

 private:
  /// In the order of LinkNumber.
  struct LinkState {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d o = Eigen::Vector3d::Zero();
    Eigen::Vector3d z = Eigen::Vector3d::Zero();  // axis of its joint
    Eigen::Vector3d v = Eigen::Vector3d::Zero(), w = v, a = v, alpha = v;
  };
  static_assert(sizeof(LinkState) == kLinkNumbers * sizeof(double), "plain numbers");
  void addJoint(const Joint& joint);

  const LoopFunctions* kernel_;
  std::vector<JointShape> joints_;
  std::vector<AngleShape> angles_;  // of joints that turn
  std::vector<double> turns_;       // cosines and sines of these angles
  std::vector<LinkState> links_;
};

/// Joints between two links, fixed ones included, in the mechanism's order.
std::vector<PathStep> pathBetween(const Mechanism& mechanism, int first_link, int second_link);

}  // namespace virtual_work_dynamics
