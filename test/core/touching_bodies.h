#pragma once

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>
#include <vector>

#include "named_loop_results.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {

inline Scene sceneOf(const std::string& text) {
  return readScene(YAML::Load(text));
}

/// A chain of joints at the origin of the link before each, with the axes of that link; only the
/// links that are given one have a mass.
class BodiesOnAxes {
 public:
  BodiesOnAxes() : builder_(1) {}

  /// @returns the new link
  int add(JointType type, int parent, const Vector3l& axis, const Vector3l& at = Vector3l::Zero()) {
    const int link = builder_.add(type, parent, axis, Matrix3l::Identity(), at);
    builder_.removeInertia(link);
    return link;
  }
  int slide(int parent, const Vector3l& axis, const Vector3l& at = Vector3l::Zero()) {
    return add(JointType::kPrismatic, parent, axis, at);
  }
  int turn(int parent, const Vector3l& axis, const Vector3l& at = Vector3l::Zero()) {
    return add(JointType::kRevolute, parent, axis, at);
  }
  /// @param inertia about the centre of mass, in axes of the link
  void load(int link, double mass, const Vector3l& inertia, const Vector3l& at = Vector3l::Zero()) {
    builder_.link(link).mass = mass;
    builder_.link(link).p_KoCm_K = at;
    builder_.link(link).inertia_Cm_K = inertia.asDiagonal();
  }
  Mechanism build() const { return builder_.build(); }

  static Vector3l x() { return Vector3l::UnitX(); }
  static Vector3l y() { return Vector3l::UnitY(); }
  static Vector3l z() { return Vector3l::UnitZ(); }

 private:
  RobotBuilder builder_;
};

inline Motion motionOf(const std::vector<double>& q, const std::vector<double>& qd,
                       const std::vector<double>& qdd) {
  Motion motion(static_cast<Eigen::Index>(q.size()));
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    motion.q[row] = q[i];
    motion.qd[row] = qd[i];
    motion.qdd[row] = qdd[i];
  }
  return motion;
}

inline void expectForce(const Eigen::Vector3d& expected, const Eigen::Vector3d& found,
                        double tolerance) {
  ASSERT_TRUE(found.allFinite());
  EXPECT_LE((expected - found).cwiseAbs().maxCoeff(), tolerance)
      << expected.transpose() << " and " << found.transpose();
}

/// The largest entry of how far a sample violates its closures.
inline double violation(const NamedLoopResults& results) {
  double most = 0;
  for (const ClosureResidual& residual : results.dynamics().residuals()) {
    most = std::max({most, residual.position, residual.velocity, residual.acceleration});
  }
  return most;
}

}  // namespace virtual_work_dynamics
