// What a motion gives decides what follows: any joints, axes of closures and poses of links.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "boom.h"
#include "loop_examples.h"
#include "offline_linkage.h"

namespace virtual_work_dynamics {
namespace {

// A closed form evaluated in double against a recursion and a least-squares solution in double.
constexpr double kClosedForm = 1e-12;

// Rounding of forces of some 10 kN.
constexpr double kForces = 1e-10;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void expectClose(double actual, double expected, double tolerance = kClosedForm) {
  ASSERT_TRUE(std::isfinite(actual));
  EXPECT_LE(std::abs(actual - expected), tolerance * std::max(1.0, std::abs(expected)));
}

class OfflineGiven : public OfflineLoops {
 protected:
  void SetUp() override {
    OfflineLoops::SetUp();
    write("b.urdf", kBoom);
    write("b.yaml", boomScene(std::string(kBoomStart) + "motion: static\n"));
  }

  NumberTable boom(const std::string& arguments, const std::string& scene = "b.yaml") {
    const Run result = run("--urdf b.urdf --scene " + scene + " " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parseTable(result.out);
  }

  std::string boomFailure(const std::string& motion, const std::string& scene = "b.yaml") {
    write("m.csv", motion);
    const Run result = run("--urdf b.urdf --motion m.csv --scene " + scene);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out, "");
    const std::string start = "inverse_dynamics_offline: error: ";
    EXPECT_EQ(result.err.find(start), result.err.rfind("inverse_dynamics_offline")) << result.err;
    EXPECT_EQ(result.err.find('\n', result.err.find(start)), result.err.size() - 1) << result.err;
    return result.err.substr(result.err.find(start) + start.size());
  }

  // Newton's method ends near the best position.
  static void expectOpen(const std::string& message, const std::string& place, double amount) {
    const std::string start = place + "the loops cannot be closed: closure 'eye' stays open by ";
    ASSERT_EQ(message.find(start), 0u) << message;
    EXPECT_NEAR(std::stod(message.substr(start.size())), amount, 1e-3) << message;
  }

  static double at(const NumberTable& table, std::size_t row, const std::string& name) {
    const int column = table.column(name);
    EXPECT_GE(column, 0) << name;
    return table.rows.at(row).at(static_cast<std::size_t>(std::max(column, 0)));
  }
};

constexpr double kAngles[] = {0.2, 0.5, 0.9, 0.4, -0.1};

// The encoder is on the boom's pin, the ram has none.
TEST_F(OfflineGiven, APassivePinMovesTheRamWhosePushIsThatOfVirtualWork) {
  std::string motion = "time,position.boom_pin\n";
  double time = 0;
  for (const double angle : kAngles) {
    motion += numberText(time) + "," + numberText(-angle) + "\n";
    time += 0.1;
  }
  write("m.csv", motion);
  const NumberTable results = boom("--motion m.csv --positions");
  ASSERT_EQ(results.rows.size(), std::size(kAngles));
  for (std::size_t i = 0; i < std::size(kAngles); ++i) {
    const Boom hand(kAngles[i]);
    expectClose(at(results, i, "effort.ram"), hand.push());
    EXPECT_EQ(at(results, i, "effort.boom_pin"), 0);
    EXPECT_EQ(at(results, i, "position.boom_pin"), -kAngles[i]);
    expectClose(at(results, i, "position.ram"), hand.length);
    expectClose(at(results, i, "position.cylinder_pin"), -hand.direction);
  }
}

TEST_F(OfflineGiven, RatesFollowFromAPassivePin) {
  write("moves.yaml", boomScene(kBoomStart));
  write("m.csv",
        "time,position.boom_pin,velocity.boom_pin,acceleration.boom_pin\n0,-0.5,-0.7,0.3\n");
  const NumberTable results = boom("--motion m.csv --positions", "moves.yaml");
  const Boom hand(0.5);
  // l^2 = const - 2 (A.B), differentiated twice.
  const double curve = (Boom::kEye * (Boom::kPinX * std::cos(0.5) + Boom::kPinZ * std::sin(0.5)) -
                        hand.slope * hand.slope) /
                       hand.length;
  expectClose(at(results, 0, "velocity.ram"), hand.slope * 0.7);
  expectClose(at(results, 0, "acceleration.ram"), hand.slope * -0.3 + curve * 0.49);
}

// The output is a motion of all joints, which gives the same results.
TEST_F(OfflineGiven, PositionsThatAreWrittenAreAMotion) {
  write("moves.yaml", boomScene(kBoomStart));
  write("m.csv",
        "time,position.boom_pin,velocity.boom_pin,acceleration.boom_pin\n0,-0.5,-0.7,0.3\n");
  const Run first = run("--urdf b.urdf --scene moves.yaml --motion m.csv --positions");
  write("all.csv", first.out);
  const NumberTable all = boom("--motion all.csv --positions", "moves.yaml");
  const NumberTable once = parseTable(first.out);
  EXPECT_EQ(all.header, once.header);
  const auto last = once.header.end() - 9;
  EXPECT_EQ((std::vector<std::string>(last, once.header.end())),
            (std::vector<std::string>{"position.boom_pin", "position.cylinder_pin", "position.ram",
                                      "velocity.boom_pin", "velocity.cylinder_pin", "velocity.ram",
                                      "acceleration.boom_pin", "acceleration.cylinder_pin",
                                      "acceleration.ram"}));
  for (std::size_t j = 0; j < once.header.size(); ++j) {
    if (once.header[j].compare(0, 9, "residual.") == 0) continue;
    expectClose(all.rows.at(0)[j], once.rows.at(0)[j], kForces);
  }
}

TEST_F(OfflineGiven, WhatIsMissingOrTooMuchIsNamed) {
  EXPECT_EQ(boomFailure("time,position.boom_pin,position.ram\n0,0,1\n"),
            "m.csv: too much is given: each of 'boom_pin', 'ram' follows from the rest; leave one "
            "out, or give all joints and nothing else\n");
  EXPECT_EQ(boomFailure("time,position.boom_pin,position.eye\n0,0,1\n"),
            "m.csv: too much is given: each of 'boom_pin', 'eye' follows from the rest; leave one "
            "out, or give all joints and nothing else\n");
  EXPECT_EQ(boomFailure("time\n0\n"), "m.csv: line 1: column 'position.ram' is missing\n");
  EXPECT_EQ(boomFailure("time,position.slide\n0,1\n"),
            "m.csv: line 1: column 'position.ram' is missing; there are 'position.slide'\n");
  // A second ram on the first has a motion of its own.
  std::string two = kBoom;
  two.insert(two.find("</robot>"),
             "<link name='jib'/><joint name='jib_pin' type='continuous'><parent link='boom'/>"
             "<child link='jib'/><axis xyz='0 1 0'/></joint>");
  write("b.urdf", two);
  write("b.yaml", boomScene(kBoomStart) + "reactions: none\n");
  std::string scene = boomScene(kBoomStart);
  write("b.yaml", scene.replace(scene.find("[ram]"), 5, "[ram, jib_pin]"));
  EXPECT_EQ(boomFailure("time,position.boom_pin\n0,0\n"),
            "m.csv: too little is given: the motion of 'jib_pin' does not follow from it; 1 more "
            "is needed, such as the actuated 'jib_pin'\n");
}

TEST_F(OfflineGiven, ContradictionsAreNamedWithTheirLine) {
  write("two.yaml", [] {
    std::string scene = boomScene(kBoomStart);
    return scene.replace(scene.find("[ram]"), 5, "[ram, boom_pin]");
  }());
  const std::string start =
      "time,position.boom_pin,position.ram,velocity.boom_pin,velocity.ram,acceleration.boom_pin,"
      "acceleration.ram\n";
  const Boom hand(0.5);
  const std::string closed = "-0.5," + numberText(hand.length);
  const std::string good = start + "0," + closed + ",0,0,0,0\n";
  EXPECT_EQ(boomFailure(good + "1," + closed + ",0,0.1,0,0\n", "two.yaml"),
            "m.csv: line 3: the velocities or accelerations that are given contradict the "
            "closures\n");
  const std::string open =
      boomFailure(good + "1,-0.5," + numberText(hand.length + 0.1) + ",0,0,0,0\n", "two.yaml");
  expectOpen(open, "m.csv: line 3: ", 0.1);
}

// Two positions of the boom go with each length of the ram: above the line of the pins, and below.
TEST_F(OfflineGiven, EachRowIsOnTheBranchOfTheRowBefore) {
  write("above.yaml",
        boomScene("motion: static\nassembly: [{name: boom_pin, position: -1.4}, {name: "
                  "cylinder_pin, position: -1.2}, {name: ram, position: 1.5}]\n"));
  const double line = std::atan2(-Boom::kPinZ, -Boom::kPinX);  // of the pins, above x
  std::string motion = "time,position.ram\n";
  std::vector<double> beyond;
  for (int i = 0; i < 40; ++i) {
    // From the fold, in which all lie in one line, by steps that are a tenth of the way.
    beyond.push_back(0.25 + 1.1 * std::pow(std::sin(0.16 * i + 1.2), 2));
    motion += numberText(0.1 * i) + "," + numberText(Boom(line + beyond.back()).length) + "\n";
  }
  write("m.csv", motion);
  for (const bool below : {false, true}) {
    const NumberTable results = boom("--motion m.csv --positions", below ? "b.yaml" : "above.yaml");
    ASSERT_EQ(results.rows.size(), beyond.size());
    for (std::size_t i = 0; i < beyond.size(); ++i) {
      const double raised = line + (below ? -1 : 1) * beyond[i];
      expectClose(at(results, i, "position.boom_pin"), -raised);
      expectClose(at(results, i, "effort.ram"), Boom(raised).push(), 10 * kClosedForm);
    }
  }
}

TEST_F(OfflineGiven, MotionsPastAFoldAreRefused) {
  const double furthest = std::hypot(Boom::kPinX, Boom::kPinZ) + Boom::kEye;
  const std::string message =
      boomFailure("time,position.ram\n0,1.5\n0.1," + numberText(furthest - 0.01) + "\n0.2," +
                  numberText(furthest + 0.02) + "\n");
  expectOpen(message, "m.csv: line 4: ", 0.02);
}

// The scene places the ram where it does not reach the boom.
TEST_F(OfflineGiven, AMotionOfAllJointsNeedsNoAssembly) {
  write("far.yaml", boomScene("motion: static\nassembly: [{name: ram, position: 5}]\n"));
  EXPECT_TRUE(contains(run("--urdf b.urdf --scene far.yaml --check").err,
                       "'eye' cannot be assembled from the given start"));
  std::string motion = "time,position.boom_pin,position.cylinder_pin,position.ram\n";
  for (int i = 0; i < 2; ++i) {
    const Boom hand(kAngles[i]);
    motion += numberText(0.1 * i) + "," + numberText(-hand.angle) + "," +
              numberText(-hand.direction) + "," + numberText(hand.length) + "\n";
  }
  write("m.csv", motion);
  const NumberTable results = boom("--motion m.csv", "far.yaml");
  for (std::size_t i = 0; i < 2; ++i) {
    expectClose(at(results, i, "effort.ram"), Boom(kAngles[i]).push());
  }
  const std::string message =
      boomFailure(motion.substr(0, motion.find('\n')) + "\n0,0.2,0.1,4\n", "far.yaml");
  const std::string start =
      "m.csv: line 2: closures: 'eye' cannot be assembled from the given start: it stays open by ";
  ASSERT_EQ(message.find(start), 0u) << message;
  EXPECT_NEAR(std::stod(message.substr(start.size())),
              4 - std::hypot(Boom::kPinX, Boom::kPinZ) - Boom::kEye, 1e-6);
}

// The drive is placed where the pin is out of reach.
TEST_F(OfflineGiven, AMotionSaysWhereLoopsStartThatTheSceneCannotClose) {
  const std::string start = "assembly: [{name: drive, position: -1.5}]\n";
  write("far.yaml", pinned("0.7") + start);
  EXPECT_TRUE(contains(run("--urdf l.urdf --scene far.yaml --check").err,
                       "'pin' cannot be assembled from the given start"));
  write("m.csv", "time,position.drive,velocity.drive,acceleration.drive\n0,0.1,0,0\n");
  const NumberTable moved = table("--scene far.yaml --motion m.csv --positions", kFollow);
  EXPECT_EQ(at(moved, 0, "position.drive"), 0.1);
  EXPECT_LE(at(moved, 0, "residual.position.pin"), kClosedForm);
  write("near.yaml", pinned("0.7"));
  const NumberTable near = table("--scene near.yaml --motion m.csv --positions", kFollow);
  for (std::size_t j = 0; j < near.header.size(); ++j) {
    expectClose(moved.rows.at(0)[j], near.rows.at(0)[j]);
  }
}

// The rocker turns as the crank does, and the pin at its foot has the encoder.
TEST_F(OfflineGiven, TheAxisOfAClosureMovesTheRest) {
  const LinkageState states[] = {{0.1, 0.4, 0}, {0.3, -1.2, 2.5}, {-0.8, 3, -1}, {1.2, 0.5, 7}};
  std::string of_pin = "time,position.pin,velocity.pin,acceleration.pin\n", all = kAllColumns;
  double time = 0;
  for (const LinkageState& state : states) {
    // A driver that wraps makes no difference to a pin.
    of_pin += numberText(time) + "," + numberText(state.q + 6.283185307179586) + "," +
              numberText(state.qd) + "," + numberText(state.qdd) + "\n";
    all += row(time, state);
    time += 0.1;
  }
  write("m.csv", of_pin);
  write("all.csv", all);
  write("pin.yaml", pinned("0.5", "pin"));
  for (const char* scene : {"s.yaml", "pin.yaml"}) {
    const std::string arguments = std::string("--positions --scene ") + scene;
    const NumberTable follows =
        table(arguments + " --motion m.csv",
              "note: m.csv: of drive, elbow, wrist, computed from the closures: positions, "
              "velocities, accelerations\n");
    const NumberTable truth = table(arguments + " --motion all.csv", "");
    ASSERT_EQ(follows.rows.size(), truth.rows.size());
    for (std::size_t i = 0; i < truth.rows.size(); ++i) {
      for (std::size_t j = 0; j < truth.header.size(); ++j) {
        expectClose(follows.rows[i][j], truth.rows[i][j], 10 * kClosedForm);
      }
    }
  }
}

// Legs of a Stewart-Gough platform from poses, as columns of a file. Rates are estimated.
TEST_F(OfflineGiven, PosesMoveTheLegsOfAPlatform) {
  std::string motion =
      "time,position.pose.platform.x,position.pose.platform.y,position.pose.platform.z,"
      "position.pose.platform.qx,position.pose.platform.qy,position.pose.platform.qz,"
      "position.pose.platform.qw\n";
  for (int i = 0; i < 20; ++i) {
    const SpatialPose pose = platformPose(0.05L * i);
    Eigen::Quaterniond turn = Eigen::Quaternion<long double>(pose.R).cast<double>();
    if (i % 3 == 1) turn.coeffs() *= -1;  // the same orientation
    motion += numberText(0.05 * i);
    for (int k = 0; k < 3; ++k) motion += "," + numberText(static_cast<double>(pose.p[k]));
    for (int k = 0; k < 4; ++k) motion += "," + numberText(turn.coeffs()[k]);
    motion += "\n";
  }
  write("m.csv", motion);
  const std::string source = kSourceFolder;
  const Run result = run("--urdf " + source + "/urdf/stewart_gough.urdf --scene " + source +
                         "/config/stewart_gough_scene.yaml --motion m.csv --positions");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable results = parseTable(result.out);
  ASSERT_EQ(results.rows.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    const Positions expected = stewartGoughAt(0.05L * i);
    for (int leg = 1; leg <= 6; ++leg) {
      const std::string name = "leg_" + std::to_string(leg);
      expectClose(at(results, i, "position." + name), static_cast<double>(expected.at(name)));
    }
  }
  write("m.csv", motion.substr(0, motion.find(",position.pose.platform.qw")) + "\n0,0,0,1,0,0,0\n");
  const Run lacks = run("--urdf " + source + "/urdf/stewart_gough.urdf --scene " + source +
                        "/config/stewart_gough_scene.yaml --motion m.csv");
  EXPECT_TRUE(contains(lacks.err, "column 'position.pose.platform.qw' is missing")) << lacks.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
