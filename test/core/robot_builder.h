#pragma once

#include <Eigen/Geometry>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// Builds mechanisms joint by joint without a description, so that a test says exactly how each
/// joint lies: link_0 is the root, joint_i carries link_i. Numbers that the caller does not give
/// are random; the same seed gives the same robot.
class RobotBuilder {
 public:
  explicit RobotBuilder(unsigned seed) : generator_(seed), links_(1) { links_[0].name = "link_0"; }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  Vector3l vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }
  Vector3l direction() { return vector(1).normalized(); }
  Matrix3l rotation() {
    return Eigen::AngleAxis<long double>(uniform(0.3, 2.8), direction()).toRotationMatrix();
  }

  /// Adds a joint and its child link with a random inertia; parents must come depth first.
  /// @returns the index of the child link.
  int add(JointType type, int parent_link, const Vector3l& axis_K, const Matrix3l& R_PK,
          const Vector3l& p_PoKo_P) {
    const int k = static_cast<int>(joints_.size());
    Joint joint;
    joint.name = "joint_" + std::to_string(k + 1);
    joint.type = type;
    joint.parent_link = parent_link;
    joint.child_link = k + 1;
    joint.p_PoKo_P = p_PoKo_P;
    joint.R_PK = R_PK;
    if (type != JointType::kFixed) {
      joint.axis_K = axis_K;
      joint.coordinate = coordinates_++;
    }
    joints_.push_back(joint);
    Link link;
    link.name = "link_" + std::to_string(k + 1);
    link.parent_joint = k;
    links_.push_back(link);
    addInertia(k + 1);
    return k + 1;
  }

  /// Adds a revolute joint in general position. @returns the index of the child link.
  int add(int parent_link) {
    const Vector3l axis = direction();
    const Matrix3l R_PK = rotation();
    return add(JointType::kRevolute, parent_link, axis, R_PK, vector(0.05));
  }

  /// Makes the joint that was added last follow the first.
  void mimicFirst(double multiplier, double offset) {
    Joint& joint = joints_.back();
    joint.mimics = true;
    joint.coordinate = 0;
    joint.multiplier = multiplier;
    joint.offset = offset;
    --coordinates_;
  }

  void addInertia(int link) {
    const double mass = uniform(0.5, 2);
    const Vector3l sides{uniform(0.02, 0.1), uniform(0.02, 0.1), uniform(0.02, 0.1)};
    const Vector3l squares = sides.cwiseProduct(sides);
    const Matrix3l R = rotation();
    const Matrix3l G = mass / 12 * R * squares.asDiagonal() * R.transpose();
    links_[link].mass = mass;
    links_[link].p_KoCm_K = vector(0.05);
    links_[link].inertia_Cm_K = G.trace() * Matrix3l::Identity() - G;
  }

  void removeInertia(int link) {
    links_[link].mass = 0;
    links_[link].p_KoCm_K.setZero();
    links_[link].inertia_Cm_K.setZero();
  }

  Joint& joint(int child_link) { return joints_[child_link - 1]; }
  Link& link(int index) { return links_[index]; }

  Mechanism build() const { return Mechanism("built", links_, joints_); }

  Motion motion() {
    Motion motion(coordinates_);
    for (Eigen::Index i = 0; i < coordinates_; ++i) {
      motion.q[i] = uniform(-3, 3);
      motion.qd[i] = uniform(-2, 2);
      motion.qdd[i] = uniform(-5, 5);
    }
    return motion;
  }
  std::vector<Motion> motions(std::size_t count) {
    std::vector<Motion> motions;
    for (std::size_t n = 0; n < count; ++n) motions.push_back(motion());
    return motions;
  }

 private:
  std::mt19937 generator_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  int coordinates_ = 0;
};

/// A chain of revolute joints in general position.
inline RobotBuilder chainOf(int joints, unsigned seed = 1) {
  RobotBuilder builder(seed);
  for (int i = 0; i < joints; ++i) builder.add(i);
  return builder;
}

}  // namespace virtual_work_dynamics
