#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "loops/kinematics.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Of central differences with steps of kStep: third derivatives of some 100, and rounding.
constexpr double kStep = 1e-5;
constexpr double kDifference = 1e-7;

// Poses of all links by the recursion of the open tree.
std::vector<Pose> posesAt(const Mechanism& mechanism, const Eigen::VectorXd& q) {
  Request request;
  request.poses = true;
  for (const Joint& joint : mechanism.joints()) request.root_axes.push_back(joint.name);
  const InverseDynamics tree(mechanism, Scene(), request);
  Workspace workspace = tree.makeWorkspace();
  Motion motion(q.size());
  motion.q = q;
  tree.compute(motion, workspace);
  std::vector<Pose> poses = workspace.poses();
  poses.insert(poses.begin(), Pose());
  return poses;
}

Eigen::Vector3d placed(const Pose& pose, const Eigen::Vector3d& point) {
  return pose.position + pose.orientation * point;
}
Eigen::Vector3d seenBy(const Pose& pose, const Eigen::Vector3d& point) {
  return pose.orientation.inverse() * (point - pose.position);
}

struct TouchCase {
  Closure closure;
  int parent, child;
};

std::vector<TouchCase> casesOf(RobotBuilder& builder) {
  std::vector<TouchCase> cases;
  const std::pair<int, int> links[] = {{0, 4}, {3, 7}, {7, 2}, {5, 0}};
  for (const auto& [parent, child] : links) {
    for (int kind = 0; kind < 4; ++kind) {
      Closure closure;
      closure.name = "touch";
      closure.type = kind < 2    ? ClosureType::kRolling
                     : kind == 2 ? ClosureType::kKnifeEdge
                                 : ClosureType::kContact;
      closure.touch.radius = 0.3;
      if (kind == 1) closure.touch.tube_radius = 0.05;
      if (kind == 1) closure.touch.roller_angle = 0.6;
      closure.parent.link = "link_" + std::to_string(parent);
      closure.child.link = "link_" + std::to_string(child);
      for (LinkFrame* frame : {&closure.parent, &closure.child}) {
        frame->xyz = builder.vector(0.3).cast<double>();
        frame->rpy = builder.vector(1.4).cast<double>();
      }
      cases.push_back({closure, parent, child});
    }
  }
  return cases;
}

// Calls visit(case, mechanism, kinematics at q, q, qd) for wheels, blades and points on planes.
template <typename Visit>
void visitTouches(Visit visit) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    RobotBuilder builder = chainOf(6, seed);
    builder.add(JointType::kPrismatic, 6, builder.direction(), builder.rotation(),
                builder.vector(0.3));
    builder.add(JointType::kRevolute, 2, builder.direction(), builder.rotation(),
                builder.vector(0.3));
    const Mechanism mechanism = builder.build();
    for (const TouchCase& touch : casesOf(builder)) {
      Scene scene;
      scene.closures = {touch.closure};
      LoopKinematics kinematics(mechanism, scene);
      kinematics.adoptConstants();
      const Motion motion = builder.motion();
      kinematics.setPosition(motion.q);
      visit(touch, mechanism, kinematics, motion.q, motion.qd);
    }
  }
}

// A row tells how fast, seen from the plane, that point of the child moves which touches.
TEST(TouchConditions, RowsAreVelocitiesOfThePointThatTouches) {
  int compared = 0;
  visitTouches([&](const TouchCase& touch, const Mechanism& mechanism, LoopKinematics& kinematics,
                   const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    const std::vector<Pose> now = posesAt(mechanism, q);
    const std::vector<Pose> then = posesAt(mechanism, q + kStep * qd);
    const std::vector<Pose> before = posesAt(mechanism, q - kStep * qd);
    const Eigen::Vector3d at = seenBy(now[touch.child], kinematics.childOrigin(0));
    const auto fromPlane = [&](const std::vector<Pose>& poses) {
      return seenBy(poses[touch.parent], placed(poses[touch.child], at));
    };
    const Eigen::Vector3d velocity =
        now[touch.parent].orientation * (fromPlane(then) - fromPlane(before)) / (2 * kStep);
    const Eigen::VectorXd rates = kinematics.jacobian() * qd;
    for (Eigen::Index i = 0; i < rates.size(); ++i, ++compared) {
      EXPECT_NEAR(rates[i], kinematics.unitWrench(i).force.dot(velocity), kDifference)
          << kinematics.condition(i).name;
      EXPECT_EQ(kinematics.unitWrench(i).moment, Eigen::Vector3d::Zero());
    }
  });
  EXPECT_EQ(compared, 5 * 4 * (3 + 2 + 2 + 3));
}

// Derivatives of the rows, and of heights.
TEST(TouchConditions, RatesFollowFromDifferencesOfPositions) {
  visitTouches([&](const TouchCase&, const Mechanism&, LoopKinematics& kinematics,
                   const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    kinematics.setVelocity(qd);
    const Eigen::VectorXd turning = kinematics.turning(), rates = kinematics.jacobian() * qd;
    LoopKinematics then = kinematics, before = kinematics;
    then.setPosition(q + kStep * qd);
    before.setPosition(q - kStep * qd);
    const Eigen::VectorXd second = (then.jacobian() * qd - before.jacobian() * qd) / (2 * kStep);
    for (Eigen::Index i = 0; i < rates.size(); ++i) {
      EXPECT_NEAR(turning[i], second[i], 100 * kDifference) << kinematics.condition(i).name;
      if (!kinematics.condition(i).has_position) {
        EXPECT_EQ(kinematics.phi()[i], 0);
        continue;
      }
      EXPECT_NEAR(rates[i], (then.phi()[i] - before.phi()[i]) / (2 * kStep), kDifference)
          << kinematics.condition(i).name;
    }
  });
}

// The point that touches is the lowest one of the torus.
TEST(TouchConditions, WheelTouchesWithItsLowestPoint) {
  visitTouches([&](const TouchCase& touch, const Mechanism&, LoopKinematics& kinematics,
                   const Eigen::VectorXd&, const Eigen::VectorXd&) {
    if (touch.closure.type != ClosureType::kRolling) return;
    const Eigen::Vector3d normal = kinematics.freeAxis(0), P = kinematics.parentOrigin(0);
    const auto& closure = kinematics.closure(0);
    const Eigen::Matrix3d R = kinematics.links().axesOf(closure.child());
    const Eigen::Vector3d centre = kinematics.links().originOf(closure.child());
    double lowest = std::numeric_limits<double>::infinity();
    const int steps = 120;
    for (int i = 0; i < steps; ++i) {
      const double around = 2 * M_PI * i / steps;
      const Eigen::Vector3d out = std::cos(around) * R.col(0) + std::sin(around) * R.col(1);
      const Eigen::Vector3d middle = centre + touch.closure.touch.radius * out;
      for (int j = 0; j < steps; ++j) {
        const double about = 2 * M_PI * j / steps;
        const Eigen::Vector3d across = std::cos(about) * out + std::sin(about) * R.col(2);
        const Eigen::Vector3d point = middle + touch.closure.touch.tube_radius * across;
        lowest = std::min(lowest, normal.dot(point - P));
      }
    }
    const double height = normal.dot(kinematics.childOrigin(0) - P);
    EXPECT_LE(height, lowest + 1e-12);
    EXPECT_NEAR(height, lowest, 1e-3);  // the square of a step, times the radius
    EXPECT_NEAR(kinematics.phi()[kinematics.conditions() - 1], height, 1e-12);
    const Eigen::Matrix3d axes = kinematics.childAxes(0);
    EXPECT_LE((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(axes.determinant(), 1, 1e-12);
    EXPECT_GT(axes.col(1).dot(R.col(2)), 0);
  });
}

}  // namespace
}  // namespace virtual_work_dynamics
