#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "touching_bodies.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {
namespace {

// Half a unit of the last digit that is printed.
constexpr double kPrinted = 0.5e-8;
// Closed forms of a few ten operations with numbers up to some hundred.
constexpr double kClosedForm = 1e-12;
// Of the sum of two products.
constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();

const char* const kDisc = R"(
rolling: [{name: edge, link: link_6, axis: [0, 1, 0], radius: 0.5, plane: {link: link_0}}]
gravity: [0, 0, -9.81]
actuated: []
free_motion: true
assembly: [{name: joint_3, position: 0.5}]
)";

std::string refusalOf(const Mechanism& mechanism, const Scene& scene) {
  try {
    ClosedLoopDynamics(mechanism, scene, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

// A disc on slides x, y and z, then turns about z, x and its axle, y.
Mechanism disc(double mass, double across, double along) {
  BodiesOnAxes bodies;
  int link = 0;
  for (const Vector3l& axis : {bodies.x(), bodies.y(), bodies.z()}) link = bodies.slide(link, axis);
  for (const Vector3l& axis : {bodies.z(), bodies.x(), bodies.y()}) link = bodies.turn(link, axis);
  bodies.load(link, mass, {across, along, across});
  return bodies.build();
}

// The disc leans inwards by b on a circle of radius R: nothing but gravity and the contact drives
// it at that rate, from free bodies by hand.
TEST(Rolling, DiscTurnsSteadily) {
  const double m = 3, r = 0.5, A = 0.1875, C = 0.375, b = 0.3, R = 2, g = 9.81;
  const double R_c = R - r * std::sin(b);
  const double rate =
      std::sqrt(m * g * r * std::sin(b) /
                (m * r * R_c * std::cos(b) + C * std::cos(b) * (R / r - std::sin(b)) +
                 A * std::sin(b) * std::cos(b)));
  EXPECT_NEAR(rate, 1.0382156746, 0.5e-10);
  const Mechanism mechanism = disc(m, A, C);
  const Motion motion =
      motionOf({R_c, 0, r * std::cos(b), M_PI / 2, -b, 0.7},
               {0, rate * R_c, 0, rate, 0, rate * R / r}, {-rate * rate * R_c, 0, 0, 0, 0, 0});
  const NamedLoopResults results(mechanism, sceneOf(kDisc), motion);
  EXPECT_LE(violation(results), kClosedForm);
  // What it would take beyond gravity and the contact.
  EXPECT_LE(results.dynamics().effort().cwiseAbs().maxCoeff(), kClosedForm * m * g);
  const Wrench root = results.rootAxes("edge"), own = results.childAxes("edge");
  expectForce({-5.98954252, 0, 29.43}, root.force, kPrinted);
  expectForce({-m * rate * rate * R_c, 0, m * g}, root.force, kClosedForm * m * g);
  // Rolling, lateral, normal: the axle points inwards.
  expectForce({0, m * rate * rate * R_c, m * g}, own.force, kClosedForm * m * g);
  expectForce(Eigen::Vector3d::Zero(), root.torque, 0);
  for (const bool determined : results.rootAxesDetermined("edge")) EXPECT_TRUE(determined);
}

// EXUDYN's rollingCoinTest at t = 0, with numbers of nine equations of Newton and Euler, for a ring
// that turns about the vertical, leaning by 1 degree, as a floating body.
TEST(Rolling, CoinMatchesNewtonAndEuler) {
  const double r = 0.01, tilt = M_PI / 180;
  BodiesOnAxes bodies;
  bodies.add(JointType::kFixed, 0, bodies.x());
  bodies.load(1, 1, {0.5L * r * r, 0.25L * r * r, 0.25L * r * r});
  const Scene scene = sceneOf(R"(
rolling: [{name: edge, link: link_1, axis: [1, 0, 0], radius: 0.01, plane: {link: link_0}}]
joint_types: [{name: joint_1, type: floating}]
gravity: [0, 0, -9.81]
actuated: []
free_motion: true
assembly: [{name: joint_1.z, position: 0.01}]
)");
  const Mechanism mechanism = withJointTypes(bodies.build(), scene);
  Motion motion(6, 1);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
  motion.orientations[0] = Eigen::Quaterniond(R);
  motion.q.head<3>() << r * std::sin(tilt), 0, r * std::cos(tilt);
  const Eigen::Vector3d w(0, 0, 10 * M_PI), lever = -r * R.col(2);
  const Eigen::Vector3d a(0.13689316, 0, -0.00539609), alpha(0, 30.91885988, 0);
  motion.qd.head<3>() = -w.cross(lever);
  const Eigen::Vector3d rates = R.transpose() * w, turned = R.transpose() * alpha;
  motion.qd.tail<3>() = rates;
  // Angles about x, y and z follow each other, so that their rates turn the axes of the later ones.
  motion.qdd.head<3>() = a;
  motion.qdd.tail<3>() =
      turned - Eigen::Vector3d(rates[1] * rates[2], -rates[0] * rates[2], rates[0] * rates[1]);
  const NamedLoopResults results(mechanism, scene, motion);
  // Seven digits of accelerations, of which some 30 rad/s^2.
  EXPECT_LE(violation(results), 3e-8);
  EXPECT_LE(results.dynamics().effort().cwiseAbs().maxCoeff(), 3e-8);
  expectForce({0.13689316, 0, 9.80460391}, results.rootAxes("edge").force, 2 * kPrinted);
}

// A wheel on a horizontal axle, which is hinged on a shaft, presses on the ground by its gyroscopic
// moment, too.
TEST(Rolling, EdgeMillPressesByItsGyroscopicMoment) {
  const double m = 30, r = 0.5, C = 3.75, rate = 2, R = 1.3;
  BodiesOnAxes bodies;
  const int shaft = bodies.turn(0, bodies.z(), {0, 0, r});
  const int hinge = bodies.turn(shaft, bodies.y());
  const int wheel = bodies.turn(hinge, bodies.x(), {R, 0, 0});
  bodies.load(wheel, m, {C, C / 2, C / 2});
  const Mechanism mechanism = bodies.build();
  // The hinge would bear a lateral force as well, so that the wheel is one that slips sideways.
  const Scene scene = sceneOf(R"(
rolling: [{name: edge, link: link_3, axis: [1, 0, 0], radius: 0.5, slip: lateral,
           plane: {link: link_0}}]
gravity: [0, 0, -9.81]
actuated: [joint_1]
)");
  const Motion motion = motionOf({0.4, 0, 0}, {rate, 0, -rate * R / r}, {0, 0, 0});
  const NamedLoopResults results(mechanism, scene, motion);
  EXPECT_LE(violation(results), kClosedForm);
  const Wrench force = results.childAxes("edge");
  EXPECT_NEAR(force.force.z(), 324.3, kClosedForm * 324.3);
  EXPECT_NEAR(force.force.z(), m * 9.81 + C * rate * rate / r, kClosedForm * 324.3);
  EXPECT_NEAR(force.force.x(), 0, kClosedForm * 324.3);
  // Nothing acts sideways but a rounding of what acts along.
  EXPECT_LE(std::abs(force.force.y()), kRounding * std::abs(force.force.x()));
  EXPECT_NEAR(results.effort("joint_1"), 0, kClosedForm * 324.3);
}

// A ball has no axle, so that where it seems to point does not matter: upright it rolls as it does
// when it lies.
TEST(Rolling, ABallRollsHoweverItsAxleStands) {
  const double r = 0.2, m = 2, I = 0.4 * m * r * r, a = 3;
  BodiesOnAxes bodies;
  int link = 0;
  for (const Vector3l& axis : {bodies.x(), bodies.y(), bodies.z()}) link = bodies.slide(link, axis);
  for (const Vector3l& axis : {bodies.z(), bodies.x(), bodies.y()}) link = bodies.turn(link, axis);
  bodies.load(link, m, {I, I, I});
  const Mechanism mechanism = bodies.build();
  for (const char* axis : {"[0, 0, 1]", "[1e-9, 0, 1]", "[0, 1, 0]", "[1, 2, 3]"}) {
    SCOPED_TRACE(axis);
    const Scene scene = sceneOf(std::string("rolling: [{name: ball, link: link_6, axis: ") + axis +
                                R"(, radius: 0, tube_radius: 0.2, plane: {link: link_0}}]
gravity: [0, 0, -9.81]
actuated: []
free_motion: true
assembly: [{name: joint_3, position: 0.2}]
)");
    const Motion motion =
        motionOf({0, 0, r, 0, 0, 0}, {0.8, 0, 0, 0, 0, 0.8 / r}, {a, 0, 0, 0, 0, a / r});
    const NamedLoopResults results(mechanism, scene, motion);
    EXPECT_LE(violation(results), kClosedForm);
    EXPECT_EQ(results.dynamics().determinacy().free_motions, 0);
    EXPECT_EQ(results.dynamics().determinacy().redundant_constraints, 0);
    // What it would take beyond the contact does as much work.
    EXPECT_NEAR(results.effort("joint_1") + results.effort("joint_6") / r, m * a + I * a / (r * r),
                kClosedForm * m * a);
    expectForce({m * a - results.effort("joint_1"), 0, m * 9.81}, results.rootAxes("ball").force,
                kClosedForm * m * 9.81);
    // In axes of the plane.
    expectForce(results.rootAxes("ball").force, results.childAxes("ball").force,
                kClosedForm * m * 9.81);
  }
  // Of one that slips along its axle alone the axle says where.
  EXPECT_EQ(refusalOf(mechanism, sceneOf(R"(
rolling: [{name: ball, link: link_6, axis: [0, 0, 1], radius: 0, tube_radius: 0.2, slip: lateral,
           plane: {link: link_0}}]
actuated: []
free_motion: true
)")),
            "rolling: 'ball': its axle is parallel to the plane's normal");
}

TEST(Rolling, AWheelThatDoesNotTouchItsPlaneIsRefused) {
  BodiesOnAxes bodies;
  const int x = bodies.slide(0, bodies.x());
  bodies.load(bodies.turn(x, bodies.y(), {0, 0, 0.5}), 1, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  const auto wheel = [&](const std::string& point) {
    return refusalOf(mechanism, sceneOf(R"(
rolling: [{name: w, link: link_2, axis: [0, 1, 0], radius: 0.1, normal: false,
           plane: {link: link_0, point: [)" +
                                        point + "]}}]\nactuated: [joint_2]\n"));
  };
  EXPECT_EQ(wheel("0, 0, 0.4"), "none");
  EXPECT_EQ(wheel("70, -3, 0.395"), "none");
  for (const char* point : {"0, 0, 0", "0, 0, 0.385", "0, 0, 0.415", "0, 0, 1"}) {
    EXPECT_EQ(wheel(point),
              "rolling: 'w': it does not touch its plane, and with normal: false nothing moves it "
              "there")
        << point;
  }
}

// What is lifted has no directions, and may lie as it likes.
TEST(Rolling, WhatIsLiftedMayHaveAnyAttitude) {
  BodiesOnAxes bodies;
  const int x = bodies.slide(0, bodies.x());
  bodies.load(bodies.turn(x, bodies.y()), 1, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  for (const char* touch :
       {"rolling: [{name: w, link: link_2, axis: [0, 0, 1], radius: 1, ",
        "rolling: [{name: w, link: link_2, axis: [0, 1, 0], radius: 1, normal: false, ",
        "knife_edges: [{name: k, link: link_2, direction: [0, 0, 1], "}) {
    Scene scene = sceneOf(touch + std::string("plane: {link: link_0}}]\n") +
                          "actuated: [joint_1, joint_2]\n");
    EXPECT_NE(refusalOf(mechanism, scene), "none") << touch;
    scene.closures[0].touch.closed = false;
    EXPECT_EQ(refusalOf(mechanism, scene), "none") << touch;
  }
}

// Released at rest on an incline while its body turns at a steady rate, a blade's point moves on a
// cycloid: classic.
TEST(KnifeEdge, OnAnInclineMovesOnACycloid) {
  const double m = 2, g = 9.81, slope = 0.35, w = 1.7, down = g * std::sin(slope);
  BodiesOnAxes bodies;
  const int x = bodies.slide(0, bodies.x()), y = bodies.slide(x, bodies.y());
  bodies.load(bodies.turn(y, bodies.z()), m, {0.1, 0.2, 0.3});
  const Mechanism mechanism = bodies.build();
  Scene scene = sceneOf(R"(
knife_edges: [{name: blade, link: link_3, direction: [1, 0, 0], normal: false,
               plane: {link: link_0}}]
actuated: [joint_3]
free_motion: true
)");
  scene.gravity = {down, 0, -g * std::cos(slope)};
  for (const double t : {0.0, 0.3, 1.1, 2.6}) {
    const double s = std::sin(w * t), c = std::cos(w * t), v = down / w * s, vd = down * c;
    const Motion motion =
        motionOf({down / (2 * w * w) * s * s, down / (2 * w * w) * (w * t - s * c), w * t},
                 {v * c, v * s, w}, {vd * c - v * w * s, vd * s + v * w * c, 0});
    const NamedLoopResults results(mechanism, scene, motion);
    EXPECT_LE(violation(results), kClosedForm);
    EXPECT_LE(results.dynamics().effort().cwiseAbs().maxCoeff(), kClosedForm * m * g);
    expectForce({0, 2 * m * down * s, 0}, results.childAxes("blade").force, kClosedForm * m * g);
    EXPECT_TRUE(results.rootAxesDetermined("blade")[0] && results.rootAxesDetermined("blade")[1]);
  }
}

// Chaplygin's sleigh: a free body on a blade behind its centre of mass.
TEST(KnifeEdge, CarriesChaplyginsSleigh) {
  const double m = 2, d = 0.4, I = 0.3, v = 1.3, w = 0.9, angle = 0.6;
  BodiesOnAxes bodies;
  const int x = bodies.slide(0, bodies.x()), y = bodies.slide(x, bodies.y());
  bodies.load(bodies.turn(y, bodies.z()), m, {0.1, 0.2, I}, {d, 0, 0});
  const Mechanism mechanism = bodies.build();
  const Scene scene = sceneOf(R"(
knife_edges: [{name: blade, link: link_3, direction: [1, 0, 0], normal: false,
               plane: {link: link_0}}]
actuated: []
free_motion: true
)");
  const double vd = d * w * w, wd = -m * d * v * w / (I + m * d * d);
  const double s = std::sin(angle), c = std::cos(angle);
  const Motion motion =
      motionOf({0.2, -0.3, angle}, {v * c, v * s, w}, {vd * c - v * w * s, vd * s + v * w * c, wd});
  const NamedLoopResults results(mechanism, scene, motion);
  EXPECT_LE(violation(results), kClosedForm);
  EXPECT_LE(results.dynamics().effort().cwiseAbs().maxCoeff(), kClosedForm);
  expectForce({0, m * (v * w + d * wd), 0}, results.childAxes("blade").force, kClosedForm);
}

}  // namespace
}  // namespace virtual_work_dynamics
