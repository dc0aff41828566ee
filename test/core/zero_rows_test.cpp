#include "loops/zero_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kSizesOfLoops[] = {1e-9, 1e-6, 1, 3e5, 1e9};  // m

std::vector<bool> zeroRowsWith(const Mechanism& mechanism, const Closure& closure,
                               const Eigen::VectorXd& q) {
  Scene scene;
  scene.closures.push_back(closure);
  LoopKinematics kinematics(mechanism, scene);
  kinematics.setPosition(q);
  return zeroRows(mechanism, kinematics);
}

Closure closureToRoot(ClosureType type, const std::string& child, const Eigen::Vector3d& parent_xyz,
                      const Eigen::Vector3d& child_xyz) {
  Closure closure;
  closure.name = "closure";
  closure.type = type;
  closure.parent.link = "link_0";
  closure.parent.xyz = parent_xyz;
  closure.child.link = child;
  closure.child.xyz = child_xyz;
  return closure;
}

// A ball joint holds a slide whose direction is off an axis by a little: of its force, little is
// across, but it is there. In which unit lengths are given does not matter.
TEST(ZeroRows, ASlideThatIsHardlyObliqueHasNone) {
  for (const double size : kSizesOfLoops) {
    SCOPED_TRACE(size);
    RobotBuilder builder(1);
    const double oblique = 3e-12;
    builder.add(JointType::kPrismatic, 0, Vector3l(oblique, std::sqrt(1 - oblique * oblique), 0),
                Matrix3l::Identity(), Vector3l(size, 0, 0));
    const Closure ball =
        closureToRoot(ClosureType::kSpherical, "link_1", {size, size / 2, 0}, {0, size / 2, 0});
    EXPECT_EQ(zeroRowsWith(builder.build(), ball, Eigen::VectorXd::Zero(1)),
              (std::vector<bool>{false, false, true}));
  }
}

// A plane's origin is any of its points, and no lever is small against its distance.
TEST(ZeroRows, APlaneWithAPointFarAwayHasNoneMore) {
  RobotBuilder builder(1);
  builder.add(JointType::kRevolute, 0, Vector3l::UnitY(), Matrix3l::Identity(), Vector3l::Zero());
  for (const double away : {0.0, 1e6, 1e15}) {
    Closure foot = closureToRoot(ClosureType::kContact, "link_1", {away, 0, 0}, {0.1, 0, 0});
    foot.touch.slip = Slip::kAll;
    EXPECT_EQ(zeroRowsWith(builder.build(), foot, Eigen::VectorXd::Zero(1)),
              std::vector<bool>{false})
        << away;
  }
}

// What is left out changes results by its lever over the loop's extent, which has to be rounding.
TEST(ZeroRows, AFrameBesideAnAxisHasOnesOfRoundingOnly) {
  constexpr double kEps = std::numeric_limits<double>::epsilon();
  for (const double size : kSizesOfLoops) {
    SCOPED_TRACE(size);
    RobotBuilder builder(1);
    builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
    const auto rowsBeside = [&](double lever) {
      const Eigen::Vector3d at(lever * size, 0, size);
      return zeroRowsWith(builder.build(), closureToRoot(ClosureType::kSpherical, "link_1", at, at),
                          Eigen::VectorXd::Zero(1));
    };
    EXPECT_EQ(rowsBeside(45 * kEps), (std::vector<bool>{false, false, true}));
    EXPECT_EQ(rowsBeside(0), (std::vector<bool>{true, true, true}));
  }
}

// A loop without any extent has a size all the same, or its slides would count as nothing.
TEST(ZeroRows, ALoopThatLiesInOnePointHasThoseOfOtherLoops) {
  RobotBuilder builder(1);
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), Matrix3l::Identity(), Vector3l::Zero());
  const Eigen::Vector3d root = Eigen::Vector3d::Zero();
  for (const double away : kSizesOfLoops) {
    SCOPED_TRACE(away);
    EXPECT_EQ(
        zeroRowsWith(builder.build(), closureToRoot(ClosureType::kSpherical, "link_1", root, root),
                     Eigen::VectorXd::Zero(1)),
        (std::vector<bool>{false, true, true}));
    const Eigen::Vector3d at(0, away, 0);
    EXPECT_EQ(
        zeroRowsWith(builder.build(), closureToRoot(ClosureType::kSpherical, "link_1", at, at),
                     Eigen::VectorXd::Zero(1)),
        (std::vector<bool>{false, true, true}));
  }
}

// Those across the plane, which nothing in it moves along, nor turns about its lines.
TEST(ZeroRows, APlanarLoopHasThoseAcrossItsPlaneHoweverItLies) {
  for (const double size : kSizesOfLoops) {
    SCOPED_TRACE(size);
    RobotBuilder builder(7);
    const Matrix3l upright = Matrix3l::Identity();
    builder.add(JointType::kFixed, 0, Vector3l::Zero(), builder.rotation(),
                Vector3l(size, size, size));
    for (int k = 1; k <= 2; ++k) {
      builder.add(JointType::kRevolute, k, Vector3l::UnitZ(), upright, Vector3l(size, 0, 0));
    }
    builder.add(JointType::kPrismatic, 3, Vector3l::UnitY(), upright, Vector3l(0, size, 0));
    Closure pin =
        closureToRoot(ClosureType::kRevolute, "link_4", {2 * size, size, 0}, {size, 0, 0});
    pin.parent.link = "link_1";
    EXPECT_EQ(zeroRowsWith(builder.build(), pin, Eigen::VectorXd::Zero(3)),
              (std::vector<bool>{false, false, true, true, true}));
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
