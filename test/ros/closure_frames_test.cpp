#include "ros/closure_frames.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "slider_crank.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

TEST(ClosureFrames, AreThoseOfTheChildren) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  Scene scene = slider_crank.scene("joint_1");
  scene.closures[0].child.xyz << 1, 2, 3;
  scene.closures[0].child.rpy << 0.3, -0.5, 1.1;
  const auto message = closureFrames(mechanism, scene, {"joint_1", "pin"}, "left/");
  ASSERT_EQ(message.transforms.size(), 1u);
  EXPECT_EQ(message.transforms[0].header.frame_id, "left/link_3");
  EXPECT_EQ(message.transforms[0].child_frame_id, "left/pin");
  EXPECT_EQ(message.transforms[0].transform.translation.z, 3);
  const auto& turn = message.transforms[0].transform.rotation;
  const Eigen::Matrix3d R = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).matrix();
  // The angles are about fixed axes: x stays in the plane that roll does not change, and pitch
  // gives its height.
  EXPECT_NEAR(R(2, 0), -std::sin(-0.5), 1e-15);
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 1.1, 1e-15);
  EXPECT_NEAR(std::atan2(R(2, 1), R(2, 2)), 0.3, 1e-15);
  EXPECT_TRUE(closureFrames(mechanism, scene, {"joint_1"}, "").transforms.empty());
  scene.closures[0].name = "link_2";
  EXPECT_THROW(closureFrames(mechanism, scene, {"link_2"}, ""), SceneError);
  scene.closures[0].type = ClosureType::kContact;  // whose frame moves, on /tf
  EXPECT_THROW(closureFrames(mechanism, scene, {"link_2"}, ""), SceneError);
  scene.closures[0].name = "heel";
  EXPECT_TRUE(closureFrames(mechanism, scene, {"heel"}, "").transforms.empty());
}

}  // namespace
}  // namespace virtual_work_dynamics
