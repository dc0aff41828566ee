#include <gtest/gtest.h>

#include <cmath>

#include "touching_bodies.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kClosedForm = 1e-12;

// A base on slides x and y and a turn about z, its centre of mass 0.1 m ahead of the axle, and two
// wheels that have nothing but an inertia about their axles.
struct DifferentialDrive {
  static constexpr double m = 12, I = 0.8, d = 0.1, b = 0.25;
  double r = 0.09, I_w = 0.02;

  Mechanism mechanism() const {
    BodiesOnAxes bodies;
    const int x = bodies.slide(0, bodies.x()), y = bodies.slide(x, bodies.y());
    const int base = bodies.turn(y, bodies.z());
    bodies.load(base, m, {0.3, 0.5, I}, {d, 0, 0.2});
    bodies.load(bodies.turn(base, bodies.y(), {0, b, r}), 0, {0, I_w, 0});
    bodies.load(bodies.turn(base, bodies.y(), {0, -b, r}), 0, {0, I_w, 0});
    return bodies.build();
  }

  Scene scene() const {
    Scene scene = sceneOf(R"(
rolling:
  - {name: left, link: link_4, axis: [0, 1, 0], radius: 0.09, normal: false, plane: {link: link_0}}
  - {name: right, link: link_5, axis: [0, 1, 0], radius: 0.09, normal: false, plane: {link: link_0}}
gravity: [0, 0, -9.81]
actuated: [joint_4, joint_5]
)");
    for (Closure& closure : scene.closures) closure.touch.radius = r;
    return scene;
  }

  // Of the point between the wheels: speed, rate of turning and their derivatives.
  Motion motion(double angle, double v, double w, double vd, double wd) const {
    const double s = std::sin(angle), c = std::cos(angle);
    return motionOf(
        {0.3, 0.2, angle, 0.5, -0.8}, {v * c, v * s, w, (v - b * w) / r, (v + b * w) / r},
        {vd * c - v * w * s, vd * s + v * w * c, wd, (vd - b * wd) / r, (vd + b * wd) / r});
  }
};

// Torques of the motors by hand.
struct DriveTorques {
  DriveTorques(const DifferentialDrive& of, double v, double w, double vd, double wd) {
    const double turning = of.I_w / (of.r * of.r);
    const double sum = of.r * ((of.m + 2 * turning) * vd - of.m * of.d * w * w);
    const double difference =
        of.r / of.b *
        ((of.I + of.m * of.d * of.d + 2 * of.b * of.b * turning) * wd + of.m * of.d * v * w);
    left = (sum - difference) / 2;
    right = (sum + difference) / 2;
    left_force = (left - of.I_w * (vd - of.b * wd) / of.r) / of.r;
    right_force = (right - of.I_w * (vd + of.b * wd) / of.r) / of.r;
    lateral_sum = of.m * (v * w + of.d * wd);
  }
  double left, right, left_force, right_force, lateral_sum;
};

void expectDrive(const DifferentialDrive& drive, double angle, double tolerance) {
  const double v = 0.8, w = 1.1, vd = -0.6, wd = 0.9;
  const Mechanism mechanism = drive.mechanism();
  const Motion motion = drive.motion(angle, v, w, vd, wd);
  const NamedLoopResults results(mechanism, drive.scene(), motion);
  const DriveTorques expected(drive, v, w, vd, wd);
  EXPECT_LE(violation(results), tolerance * std::max(1.0, motion.qdd.cwiseAbs().maxCoeff()));
  EXPECT_NEAR(results.effort("joint_4"), expected.left, tolerance * std::abs(expected.left));
  EXPECT_NEAR(results.effort("joint_5"), expected.right, tolerance * std::abs(expected.right));
  EXPECT_TRUE(results.effortDetermined("joint_4"));
  EXPECT_TRUE(results.effortDetermined("joint_5"));
  const Wrench on_left = results.childAxes("left"), on_right = results.childAxes("right");
  EXPECT_NEAR(on_left.force.x(), expected.left_force, 10 * tolerance);
  EXPECT_NEAR(on_right.force.x(), expected.right_force, 10 * tolerance);
  // Both wheels hold the same point from slipping sideways.
  EXPECT_NEAR(on_left.force.y() + on_right.force.y(), expected.lateral_sum, 10 * tolerance);
  for (const char* wheel : {"left", "right"}) {
    const Determined& determined = results.childAxesDetermined(wheel);
    EXPECT_TRUE(determined[0]) << wheel;
    EXPECT_FALSE(determined[1]) << wheel;
    EXPECT_TRUE(determined[2] && determined[3] && determined[4] && determined[5]) << wheel;
  }
  EXPECT_EQ(results.dynamics().determinacy().redundant_constraints, 1);
}

TEST(DifferentialDriveOnWheels, TorquesMatchTheirClosedForm) {
  for (const double angle : {0.0, 0.7, 2.9}) expectDrive(DifferentialDrive(), angle, kClosedForm);
}

// Down to a micrometre, at a million radians per second. Rounding errors of the positions, whose
// differences are the radius, count relative to it.
TEST(DifferentialDriveOnWheels, SmallWheelsAreNoTrouble) {
  for (double r = 1; r > 0.5e-6; r /= 10) {
    SCOPED_TRACE(r);
    expectDrive({r, 2 * r * r}, 0.7, 1e-12 + 1e-16 / r);
  }
}

// Any point of the plane says the same of it.
TEST(DifferentialDriveOnWheels, ThePointOfThePlaneDoesNotMatter) {
  const DifferentialDrive drive;
  const Mechanism mechanism = drive.mechanism();
  const Motion motion = drive.motion(0.7, 0.8, 1.1, -0.6, 0.9);
  const double usual =
      NamedLoopResults(mechanism, drive.scene(), motion).dynamics().determinacy().condition;
  EXPECT_LT(usual, 10);
  for (const double away : {100.0, 1e4, 1e6}) {
    SCOPED_TRACE(away);
    Scene scene = drive.scene();
    for (Closure& closure : scene.closures) closure.parent.xyz.x() = away;
    const NamedLoopResults results(mechanism, scene, motion);
    EXPECT_NEAR(results.dynamics().determinacy().condition, usual, 1e-9 * usual);
    for (const char* wheel : {"left", "right"}) {
      EXPECT_TRUE(results.childAxesDetermined(wheel)[0]) << wheel;
      EXPECT_FALSE(results.childAxesDetermined(wheel)[1]) << wheel;
    }
  }
}

// Slides that carry the vehicle have no levers: far away, only roundings of positions count.
TEST(DifferentialDriveOnWheels, FarFromItsRootItIsNoMoreSingular) {
  const DifferentialDrive drive;
  const Mechanism mechanism = drive.mechanism();
  Motion motion = drive.motion(0.7, 0.8, 1.1, -0.6, 0.9);
  motion.q.head<2>() << 5e5, 4e6;
  Scene scene = drive.scene();
  scene.assembly = {{"joint_1", 5e5}, {"joint_2", 4e6}};
  const NamedLoopResults results(mechanism, scene, motion);
  EXPECT_LT(results.dynamics().determinacy().condition, 1e4);
  EXPECT_EQ(results.dynamics().determinacy().redundant_constraints, 1);
  for (const char* wheel : {"left", "right"}) {
    EXPECT_TRUE(results.childAxesDetermined(wheel)[0]) << wheel;
    EXPECT_FALSE(results.childAxesDetermined(wheel)[1]) << wheel;
  }
}

// Rates follow from those of the wheels; positions, which no condition restricts, stay.
TEST(DifferentialDriveOnWheels, RatesFollowFromTheWheels) {
  const DifferentialDrive drive;
  const Mechanism mechanism = drive.mechanism();
  ClosedLoops loops(mechanism, drive.scene());
  const Motion whole = drive.motion(0.7, 0.8, 1.1, -0.6, 0.9);
  Motion motion = whole;
  motion.qd.head<3>().setZero();
  motion.qdd.head<3>().setZero();
  ASSERT_TRUE(loops.complete(motion));
  EXPECT_EQ(motion.q, whole.q);
  EXPECT_LE((motion.qd - whole.qd).cwiseAbs().maxCoeff(), kClosedForm);
  EXPECT_LE((motion.qdd - whole.qdd).cwiseAbs().maxCoeff(), kClosedForm);
}

// A platform that is free to heave, roll and pitch on wheels that bear it and slip.
Scene platform(int wheels) {
  std::string text = "gravity: [0, 0, -9.81]\nactuated: []\nfree_motion: true\nrolling:\n";
  const char* const centres[] = {"[0.3, 0.2, 0]", "[0.3, -0.2, 0]", "[-0.3, 0.2, 0]",
                                 "[-0.3, -0.2, 0]"};
  for (int i = 0; i < wheels; ++i) {
    text += "  - {name: wheel_" + std::to_string(i) + ", link: link_3, centre: " + centres[i] +
            ", axis: [0, 1, 0], radius: 0.1, slip: all, plane: {link: link_0}}\n";
  }
  Scene scene = sceneOf(text);
  scene.assembly = {{"joint_1", 0.1}};
  return scene;
}

TEST(Wheels, ThreeBearAPlatformInOneWayAndFourInMany) {
  BodiesOnAxes bodies;
  const int up = bodies.slide(0, bodies.z()), roll = bodies.turn(up, bodies.x());
  bodies.load(bodies.turn(roll, bodies.y()), 10, {1, 1, 1}, {0.1, 0.05, 0.2});
  const Mechanism mechanism = bodies.build();
  const Motion rest = motionOf({0.1, 0, 0}, {0, 0, 0}, {0, 0, 0});
  const NamedLoopResults three(mechanism, platform(3), rest);
  // About the axes through the first two wheels, and through the first and the third.
  const double weight = 98.1, back = weight * 0.2 / 0.6, right = weight * 0.15 / 0.4;
  const double expected[] = {weight - back - right, right, back};
  for (int i = 0; i < 3; ++i) {
    const std::string wheel = "wheel_" + std::to_string(i);
    EXPECT_NEAR(three.childAxes(wheel).force.z(), expected[i], kClosedForm * weight) << wheel;
    EXPECT_TRUE(three.childAxesDetermined(wheel)[2]) << wheel;
  }
  const NamedLoopResults four(mechanism, platform(4), rest);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const std::string wheel = "wheel_" + std::to_string(i);
    sum += four.childAxes(wheel).force.z();
    EXPECT_FALSE(four.childAxesDetermined(wheel)[2]) << wheel;
    EXPECT_TRUE(four.childAxesDetermined(wheel)[0]) << wheel;
  }
  EXPECT_NEAR(sum, weight, kClosedForm * weight);
}

// Four wheels with rollers at 45 degrees: torques by virtual work, with the speeds of the wheels as
// every text on mecanum drives has them.
TEST(Wheels, MecanumDriveMovesSideways) {
  const double r = 0.05, l = 0.2, b = 0.15, m = 8, I = 0.4, turn = 0.4;
  BodiesOnAxes bodies;
  const int x = bodies.slide(0, bodies.x()), y = bodies.slide(x, bodies.y());
  const int base = bodies.turn(y, bodies.z());
  bodies.load(base, m, {0.2, 0.2, I});
  std::string text = "gravity: [0, 0, -9.81]\nactuated: [joint_4, joint_5, joint_6]\nrolling:\n";
  for (int i = 0; i < 4; ++i) {
    const double ahead = i < 2 ? l : -l, aside = i % 2 == 0 ? b : -b;
    bodies.turn(base, bodies.y(), {ahead, aside, r});
    // Of the roller below front left and back right wheels: forward and to the left.
    const bool left_forward = i == 0 || i == 3;
    text += "  - {name: wheel_" + std::to_string(i) + ", link: link_" + std::to_string(4 + i) +
            ", axis: [0, 1, 0], radius: 0.05, normal: false, roller_angle: " +
            (left_forward ? "-0.7853981633974483" : "0.7853981633974483") +
            ", plane: {link: link_0}}\n";
  }
  const Mechanism mechanism = bodies.build();
  const double v_x = 0.5, v_y = -0.7, w = 0.9, a_x = 0.3, a_y = 1.1, wd = -0.6;
  const double s = std::sin(turn), c = std::cos(turn);
  // Of the base's axes; its centre of mass is the point between the wheels.
  const auto wheelSpeed = [&](int i, double along, double across, double rate) {
    const double ahead = i < 2 ? l : -l, aside = i % 2 == 0 ? b : -b;
    const double sign = i == 0 || i == 3 ? 1 : -1;
    return ((along - rate * aside) + sign * (across + rate * ahead)) / r;
  };
  const double A_x = a_x - w * v_y, A_y = a_y + w * v_x;  // acceleration in axes of the base
  Motion motion(7);
  motion.q << 0.1, 0.2, turn, 0, 0.3, 0.6, 0.9;
  motion.qd.head<3>() << c * v_x - s * v_y, s * v_x + c * v_y, w;
  motion.qdd.head<3>() << c * A_x - s * A_y, s * A_x + c * A_y, wd;
  for (int i = 0; i < 4; ++i) {
    motion.qd[3 + i] = wheelSpeed(i, v_x, v_y, w);
    motion.qdd[3 + i] = wheelSpeed(i, a_x, a_y, wd);
  }
  const NamedLoopResults results(mechanism, sceneOf(text), motion);
  EXPECT_LE(violation(results), 10 * kClosedForm);
  // sum over the wheels of torque times speed of the wheel = power into the base, for each motion.
  const double into[3] = {m * A_x, m * A_y, I * wd};
  for (int k = 0; k < 3; ++k) {
    double power = 0;
    for (int i = 0; i < 4; ++i) {
      const double rate = wheelSpeed(i, k == 0, k == 1, k == 2);
      const double effort = i < 3 ? results.effort("joint_" + std::to_string(4 + i)) : 0;
      power += rate * effort;
    }
    EXPECT_NEAR(power, into[k], 10 * kClosedForm) << k;
  }
  for (int i = 0; i < 3; ++i) {
    // A massless wheel: the roller's force times its lever is the torque.
    const Eigen::Vector3d force = results.childAxes("wheel_" + std::to_string(i)).force;
    EXPECT_NEAR(r * force.x(), results.effort("joint_" + std::to_string(4 + i)), kClosedForm);
    EXPECT_NEAR(std::abs(force.x()), std::abs(force.y()), 10 * kClosedForm);
    EXPECT_EQ(force.z(), 0);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
