#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "touching_bodies.h"

namespace virtual_work_dynamics {
namespace {

// A factorization of some ten rows against closed forms, of some hundred newtons.
constexpr double kRolled = 1e-11, kGripped = 1e-10;

// A wheel under a platform.
struct RollerWheel {
  double ahead, aside;  // of the platform's centre, m
  double axle;          // angle of its axle in the platform, rad
  double roller;        // angle of the rollers' axes from it
};

// A platform on slides x and y and a turn about z, with wheels that have inertias about their axles
// alone, and its torques by hand: no wheel slips along the axis of the roller that touches.
class RollerPlatform {
 public:
  static constexpr double r = 0.06, m = 9, I = 0.5, I_w = 0.003;

  explicit RollerPlatform(const std::vector<RollerWheel>& wheels) : wheels_(wheels) {
    const int x = bodies_.slide(0, bodies_.x()), y = bodies_.slide(x, bodies_.y());
    const int base = bodies_.turn(y, bodies_.z());
    bodies_.load(base, m, {0.2, 0.2, I});
    std::ostringstream text;
    text.precision(17);
    text << "gravity: [0, 0, -9.81]\nrolling:\n";
    std::string actuated = "actuated: [";
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      const double c = std::cos(wheels[i].axle), s = std::sin(wheels[i].axle);
      const int link = bodies_.turn(base, {c, s, 0}, {wheels[i].ahead, wheels[i].aside, r});
      bodies_.load(link, 0, Vector3l(I_w, I_w, I_w));
      turning_ += I_w;
      text << "  - {name: wheel_" << i << ", link: link_" << link << ", axis: [" << c << ", " << s
           << ", 0], radius: 0.06, normal: false, roller_angle: " << wheels[i].roller
           << ", plane: {link: link_0}}\n";
      actuated += (i == 0 ? "" : ", ") + ("joint_" + std::to_string(link));
    }
    scene_ = sceneOf(text.str() + actuated + "]");
  }

  // Rates of the wheels for a motion of the platform in its own axes.
  Eigen::VectorXd ratesOf(double along, double across, double turn) const {
    Eigen::VectorXd rates(wheels_.size());
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      const RollerWheel& wheel = wheels_[i];
      const Eigen::Vector2d v(along - turn * wheel.aside, across + turn * wheel.ahead);
      const Eigen::Vector2d forward(std::sin(wheel.axle), -std::cos(wheel.axle));
      const Eigen::Vector2d held = heldIn(wheel);
      rates[static_cast<Eigen::Index>(i)] = held.dot(v) / (r * held.dot(forward));
    }
    return rates;
  }
  // The axis of the roller that touches, in axes of the platform.
  static Eigen::Vector2d heldIn(const RollerWheel& wheel) {
    return {std::cos(wheel.axle + wheel.roller), std::sin(wheel.axle + wheel.roller)};
  }

  void check(double angle) const {
    const double v_x = 0.5, v_y = -0.7, w = 0.9, a_x = 0.3, a_y = 1.1, wd = -0.6;
    const double s = std::sin(angle), c = std::cos(angle);
    const double A_x = a_x - w * v_y, A_y = a_y + w * v_x;  // in axes of the platform
    const auto n = static_cast<Eigen::Index>(wheels_.size());
    Motion motion(3 + n);
    motion.q.head<3>() << 0.1, 0.2, angle;
    for (Eigen::Index i = 0; i < n; ++i) motion.q[3 + i] = 0.3 * static_cast<double>(i);
    motion.qd.head<3>() << c * v_x - s * v_y, s * v_x + c * v_y, w;
    motion.qdd.head<3>() << c * A_x - s * A_y, s * A_x + c * A_y, wd;
    motion.qd.tail(n) = ratesOf(v_x, v_y, w);
    const Eigen::VectorXd spun = ratesOf(a_x, a_y, wd);
    motion.qdd.tail(n) = spun;
    const Mechanism mechanism = bodies_.build();
    const NamedLoopResults results(mechanism, scene_, motion);
    EXPECT_LE(violation(results), kRolled);
    // Torques that act on the platform through the wheels.
    Eigen::MatrixXd rates(n, 3);
    rates << ratesOf(1, 0, 0), ratesOf(0, 1, 0), ratesOf(0, 0, 1);
    const Eigen::Vector3d into(m * A_x, m * A_y, (I + turning_) * wd);
    Eigen::VectorXd torques(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      torques[i] = results.effort("joint_" + std::to_string(4 + i)) - I_w * spun[i];
    }
    expectForce(into, rates.transpose() * torques, kRolled);
    if (n == 3) {
      const Eigen::VectorXd alone = rates.transpose().fullPivLu().solve(into);
      EXPECT_LE((alone - torques).norm(), kRolled);
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      // The roller turns freely: the force acts along its axis, and its lever is the torque.
      const std::string name = "wheel_" + std::to_string(i);
      const Eigen::Vector3d force = results.childAxes(name).force;
      const double roller = wheels_[static_cast<std::size_t>(i)].roller;
      EXPECT_NEAR(r * force.x(), torques[i], kRolled) << name;
      EXPECT_NEAR(std::cos(roller) * force.x() + std::sin(roller) * force.y(), 0, kRolled) << name;
      EXPECT_EQ(force.z(), 0);
    }
  }

 private:
  BodiesOnAxes bodies_;
  Scene scene_;
  std::vector<RollerWheel> wheels_;
  double turning_ = 0;  // inertias of the wheels, of which each turns with the platform, too
};

// Omni wheels, whose rollers turn about the rolling direction, around a circle.
TEST(Rollers, ThreeOmniWheelsDriveAnyWay) {
  std::vector<RollerWheel> wheels;
  for (int i = 0; i < 3; ++i) {
    const double at = 0.4 + 2 * M_PI / 3 * i;
    wheels.push_back({0.2 * std::cos(at), 0.2 * std::sin(at), at, M_PI / 2});
  }
  const RollerPlatform platform(wheels);
  for (const double angle : {0.0, 0.8, -2.5}) platform.check(angle);
}

// Three wheels in general positions, with rollers of different angles.
TEST(Rollers, RollersOfAnyAngleHoldAlongTheirAxes) {
  for (const double roller : {0.2, -0.5, M_PI / 4, 1.1, -1.4}) {
    const RollerPlatform platform(
        {{0.3, 0.1, 1.5, roller}, {-0.1, 0.25, -0.4, -roller}, {-0.2, -0.3, 2.9, 0.7 * roller}});
    platform.check(0.6);
  }
}

// Four on the corners of a car, and rollers of other angles than 45 degrees: more motors than
// motions, so that only what they do together is determined.
TEST(Rollers, FourMecanumWheelsShareWhatTheyDo) {
  for (const double roller : {0.4, M_PI / 4, 1.2}) {
    const RollerPlatform platform({{0.2, 0.15, M_PI / 2, -roller},
                                   {0.2, -0.15, M_PI / 2, roller},
                                   {-0.2, 0.15, M_PI / 2, roller},
                                   {-0.2, -0.15, M_PI / 2, -roller}});
    platform.check(-0.3);
  }
}

// Two fingers that a spring closes upon a box between them, on an arm that slides.
class Gripper {
 public:
  static constexpr double kHalf = 0.04, kBox = 1.5, kFinger = 0.3, kArm = 4;
  static constexpr double kStiffness = 800, kRest = 0.1, kFriction = 0.5;

  explicit Gripper(bool coupled) : coupled_(coupled) {
    const int base = slides(0);
    bodies_.load(base, kArm, {0.1, 0.1, 0.1});
    const int left = bodies_.slide(base, bodies_.y(), {0, -kOpen, 0});
    const int right = bodies_.slide(base, -bodies_.y(), {0, kOpen, 0});
    for (const int finger : {left, right}) bodies_.load(finger, kFinger, {1e-3, 1e-3, 1e-3});
    const int box = slides(0);
    bodies_.load(box, kBox, {1e-3, 1e-3, 1e-3});
    std::ostringstream text;
    text << "actuated: [joint_1, joint_2, joint_3]\n"
         << "given: [joint_1, joint_2, joint_3]\n"
         << "assembly: [{name: joint_4, position: " << kOpen - kHalf
         << "}, {name: joint_5, position: " << kOpen - kHalf << "}]\n"
         << "joints: [{name: joint_4, stiffness: " << kStiffness << ", rest: " << kRest << "}]\n"
         << "contacts:\n"
         << "  - {name: left, link: link_4, friction: 0.5, plane: {link: link_8, point: [0, "
         << -kHalf << ", 0], normal: [0, -1, 0]}}\n"
         << "  - {name: right, link: link_5, friction: 0.5, plane: {link: link_8, point: [0, "
         << kHalf << ", 0], normal: [0, 1, 0]}}\n"
         << "couplings: [{name: rack, offset: 0, terms: [{name: joint_4, factor: 1}, "
            "{name: joint_5, factor: -1}]}]\n";
    scene_ = sceneOf(text.str());
  }

  Mechanism mechanism() const {
    Mechanism all = bodies_.build();
    if (coupled_) return all;
    std::vector<Joint> joints = all.joints();  // the right finger mimics the left one
    joints[4].mimics = true;
    joints[4].coordinate = joints[3].coordinate;
    for (std::size_t k = 5; k < joints.size(); ++k) --joints[k].coordinate;
    return Mechanism("gripper", all.links(), joints);
  }
  Scene scene() const {
    Scene scene = scene_;
    if (coupled_) return scene;
    scene.couplings.clear();
    scene.assembly.pop_back();
    return scene;
  }

  static constexpr double kOpen = 0.07;

 private:
  // Three slides along the axes of a link.
  int slides(int link) {
    for (const Vector3l& axis : {bodies_.x(), bodies_.y(), bodies_.z()}) {
      link = bodies_.slide(link, axis);
    }
    return link;
  }

  const bool coupled_;
  BodiesOnAxes bodies_;
  Scene scene_;
};

class Grippers : public ::testing::TestWithParam<bool> {};

// The normal forces are the spring's, shifted by what the box needs sideways; of what it needs
// along the pads only the sum is determined.
TEST_P(Grippers, SqueezeABoxBetweenTwoContacts) {
  const Gripper gripper(GetParam());
  const Mechanism mechanism = gripper.mechanism();
  const Scene scene = gripper.scene();
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates().size());
  const double closing = Gripper::kOpen - Gripper::kHalf;
  const double force = Gripper::kStiffness * (Gripper::kRest - closing);
  const Eigen::Vector3d a(0.7, 2.3, -1.2);
  Motion motion(n);
  motion.q[3] = closing;
  if (GetParam()) motion.q[4] = closing;
  motion.qdd.head<3>() = motion.qdd.tail<3>() = a;
  const NamedLoopResults results(mechanism, scene, motion);
  EXPECT_LE(violation(results), kGripped);
  const Eigen::Vector3d on_left = results.rootAxes("left").force;
  const Eigen::Vector3d on_right = results.rootAxes("right").force;
  const double sideways = Gripper::kBox * a.y();
  // On the fingers.
  EXPECT_NEAR(on_left.y(), -(force + sideways) / 2, kGripped);
  EXPECT_NEAR(on_right.y(), (force - sideways) / 2, kGripped);
  EXPECT_NEAR(results.childAxes("left").force.z(), (force + sideways) / 2, kGripped);
  const double weight = Gripper::kBox * (a.z() + 9.81);
  EXPECT_NEAR(on_left.z() + on_right.z(), -weight, kGripped);
  EXPECT_NEAR(on_left.x() + on_right.x(), -Gripper::kBox * a.x(), kGripped);
  for (const char* pad : {"left", "right"}) {
    const Determined& determined = results.childAxesDetermined(pad);
    EXPECT_FALSE(determined[0]) << pad;
    EXPECT_FALSE(determined[1]) << pad;
    EXPECT_TRUE(determined[2]) << pad;
  }
  const double mass = Gripper::kArm + 2 * Gripper::kFinger + Gripper::kBox;
  EXPECT_NEAR(results.effort("joint_1"), mass * a.x(), kGripped);
  EXPECT_NEAR(results.effort("joint_2"), mass * a.y(), kGripped);
  EXPECT_NEAR(results.effort("joint_3"), mass * (a.z() + 9.81), kGripped);
  EXPECT_EQ(results.effort("joint_4"), 0);
  for (const Hold hold : results.dynamics().results().loops.holds) {
    EXPECT_EQ(hold, Hold::kNotDecidable);  // how the pads share the weight is not
  }
  if (!GetParam()) return;
  // The rack carries what the right finger presses with, and moves its mass.
  EXPECT_NEAR(std::abs(results.dynamics().effort()[n]), on_right.y() - Gripper::kFinger * a.y(),
              kGripped);
}

INSTANTIATE_TEST_SUITE_P(MimicAndCoupling, Grippers, ::testing::Bool());

}  // namespace
}  // namespace virtual_work_dynamics
