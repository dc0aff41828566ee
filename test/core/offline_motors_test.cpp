// Actuators of transmissions where motions give all joints: with wheels, couplings of rates and
// loops. What is written by hand has their columns in the motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/number_text.h"
#include "offline_tool.h"
#include "transmitting_robot.h"

namespace virtual_work_dynamics {
namespace {

using Strings = std::vector<std::string>;

struct MovedJoint {
  std::string name;
  std::function<double(double)> q, qd, qdd;
};

// Positions, velocities and accelerations of joints, and of motors as `ratios` times joints.
struct HandMotor {
  std::string name;
  double offset;
  std::vector<std::pair<std::string, double>> ratios;
};

class OfflineMotors : public OfflineTool {
 protected:
  static std::string motion(const std::vector<MovedJoint>& joints,
                            const std::vector<HandMotor>& motors, const Strings& levels) {
    std::string text = "time";
    for (const std::string& level : levels) {
      for (const MovedJoint& joint : joints) text += "," + level + "." + joint.name;
      for (const HandMotor& motor : motors) text += "," + level + "." + motor.name;
    }
    text += "\n";
    for (int i = 0; i < 40; ++i) {
      const double t = i / 50.;
      text += numberText(t);
      for (const std::string& level : levels) {
        const auto of = [&](const MovedJoint& joint) {
          return level == "position"   ? joint.q(t)
                 : level == "velocity" ? joint.qd(t)
                                       : joint.qdd(t);
        };
        for (const MovedJoint& joint : joints) text += "," + numberText(of(joint));
        for (const HandMotor& motor : motors) {
          double value = level == "position" ? motor.offset : 0;
          for (const auto& [name, ratio] : motor.ratios) {
            for (const MovedJoint& joint : joints) {
              if (joint.name == name) value += ratio * of(joint);
            }
          }
          text += "," + numberText(value);
        }
      }
      text += "\n";
    }
    return text;
  }

  static std::string motorText(const std::string& name, const std::string& link) {
    return "<link name='" + name + "'/><joint name='" + name +
           "' type='continuous'><parent link='" + link + "'/><child link='" + name +
           "'/><axis xyz='0 0 1'/></joint>";
  }

  std::string results(const std::string& arguments) {
    const Run result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    notes_ = result.err;
    return result.out;
  }

  // The same by <transmission> and by hand, to the last bit.
  void expectSame(const std::vector<MovedJoint>& joints, const std::vector<HandMotor>& motors) {
    const Strings all{"position", "velocity", "acceleration"};
    write("joints.csv", motion(joints, {}, all));
    write("all.csv", motion(joints, motors, all));
    const std::string more = " --positions --certificates --loop-tolerance 1e-6 --motion ";
    for (const std::string method : {"virtual_work", "lagrange"}) {
      const std::string how = more + "joints.csv --method " + method;
      const std::string found = results("--urdf read.urdf --scene read.yaml" + how);
      EXPECT_NE(notes_.find(", computed from the joints that they move: positions, velocities, "
                            "accelerations\n"),
                std::string::npos)
          << notes_;
      const std::string by_hand =
          results("--urdf hand.urdf --scene hand.yaml" + more + "all.csv --method " + method);
      EXPECT_EQ(notes_.find("computed from"), std::string::npos) << notes_;
      EXPECT_GT(found.size(), 1000u);
      EXPECT_EQ(found, by_hand) << method;
      // Columns of motors that a motion has are taken.
      EXPECT_EQ(found, results("--urdf read.urdf --scene read.yaml" + more + "all.csv --method " +
                               method));
    }
  }

  static MovedJoint swinging(const std::string& name, double size, double rate, double shift = 0) {
    return {name, [=](double t) { return shift + size * std::sin(rate * t); },
            [=](double t) { return size * rate * std::cos(rate * t); },
            [=](double t) { return -size * rate * rate * std::sin(rate * t); }};
  }

  std::string notes_;
};

TEST_F(OfflineMotors, MobileManipulatorWithGearboxesOnItsWheels) {
  const std::string folder = kSourceFolder;
  std::string urdf = readFile(folder + "/urdf/mobile_manipulator.urdf");
  const std::string scene = readFile(folder + "/config/mobile_manipulator_scene.yaml");
  const auto with = [&](const std::string& more) {
    std::string text = urdf;
    return text.replace(text.find("</robot>"), 8, more + "</robot>");
  };
  const auto gearbox = [](const std::string& side, const std::string& ratio) {
    return transmissionText(side, "SimpleTransmission",
                            endText("joint", side + "_wheel", "", "", "0.25") +
                                endText("actuator", side + "_motor", ratio));
  };
  write("read.urdf", with(gearbox("left", "6") + gearbox("right", "-6")));
  write("hand.urdf", with(motorText("left_motor", "base") + motorText("right_motor", "base")));
  const std::string reactions = "reactions: [left_wheel, left_tread, elbow]\n";
  write("read.yaml", scene + reactions + "urdf_transmissions: all\n");
  std::string by_hand = scene;
  const std::string old = "actuated: [left_wheel, right_wheel, pan";
  by_hand.replace(by_hand.find(old), old.size(), "actuated: [left_motor, right_motor, pan");
  write("hand.yaml", by_hand + reactions +
                         "couplings:\n"
                         "  - {name: left.left_motor, offset: -1.5, terms: [{name: left_motor, "
                         "factor: 1}, {name: left_wheel, factor: -6}]}\n"
                         "  - {name: right.right_motor, offset: 1.5, terms: [{name: right_motor, "
                         "factor: 1}, {name: right_wheel, factor: 6}]}\n");
  // A turn about a point: a circle of 0.5 m about which the base is turned by 2 sin t.
  const double r = 0.5;
  const auto yaw = [](double t) { return 0.6 * std::sin(2 * t); };
  const auto w = [](double t) { return 1.2 * std::cos(2 * t); };
  const auto a = [](double t) { return -2.4 * std::sin(2 * t); };
  const auto wheel = [&](const std::string& name, double way) {
    return MovedJoint{name, [=](double t) { return way * yaw(t) / 0.08; },
                      [=](double t) { return way * w(t) / 0.08; },
                      [=](double t) { return way * a(t) / 0.08; }};
  };
  const std::vector<MovedJoint> joints{
      {"base_x", [=](double t) { return r * std::sin(yaw(t)); },
       [=](double t) { return r * std::cos(yaw(t)) * w(t); },
       [=](double t) { return r * (std::cos(yaw(t)) * a(t) - std::sin(yaw(t)) * w(t) * w(t)); }},
      {"base_y", [=](double t) { return r * (1 - std::cos(yaw(t))); },
       [=](double t) { return r * std::sin(yaw(t)) * w(t); },
       [=](double t) { return r * (std::sin(yaw(t)) * a(t) + std::cos(yaw(t)) * w(t) * w(t)); }},
      {"base_yaw", yaw, w, a},
      wheel("left_wheel", r - 0.2),
      wheel("right_wheel", r + 0.2),
      swinging("pan", 1.2, 1.5),
      swinging("shoulder", 0.4, 2, -0.4),
      swinging("elbow", 0.7, 3, 1.2)};
  const std::vector<HandMotor> motors{{"left_motor", -1.5, {{"left_wheel", 6}}},
                                      {"right_motor", 1.5, {{"right_wheel", -6}}}};
  expectSame(joints, motors);
  // A motor turns as fast as its gearbox says, and delivers what the wheel takes by that.
  const NumberTable found = parseTable(results(
      "--urdf read.urdf --scene read.yaml --positions --motion joints.csv --loop-tolerance 1e-6"));
  write("plain.yaml", scene + reactions);
  const NumberTable plain =
      parseTable(results("--urdf " + folder +
                         "/urdf/mobile_manipulator.urdf --scene plain.yaml --motion "
                         "joints.csv --loop-tolerance 1e-6"));
  const auto at = [](const NumberTable& table, std::size_t row, const std::string& name) {
    const int column = table.column(name);
    EXPECT_GE(column, 0) << name;
    return table.rows.at(row).at(static_cast<std::size_t>(std::max(column, 0)));
  };
  for (std::size_t row = 0; row < 40; ++row) {
    EXPECT_NEAR(at(found, row, "velocity.left_motor"), 6 * at(found, row, "velocity.left_wheel"),
                1e-12);
    EXPECT_NEAR(at(found, row, "effort.left_motor"), at(plain, row, "effort.left_wheel") / 6,
                1e-12);
    EXPECT_NEAR(at(found, row, "effort.right_motor"), at(plain, row, "effort.right_wheel") / -6,
                1e-12);
  }
}

// A slide and a wrist with motors, and a belt between two joints, of which positions or rates are
// tied.
class OfflineBelts : public OfflineMotors {
 protected:
  void writeBelt(const std::string& belt, const std::string& more, const std::string& actuated,
                 const std::string& by_hand) {
    write("read.urdf",
          transmittingRobot(transmissionText("lead", "SimpleTransmission",
                                             endText("joint", "slide", "", "", "0.5") +
                                                 endText("actuator", "spindle", "250")) +
                            transmissionText("wrist", "DifferentialTransmission",
                                             endText("joint", "pitch", "", "joint1") +
                                                 endText("joint", "roll", "2", "joint2") +
                                                 endText("actuator", "left", "10", "actuator1") +
                                                 endText("actuator", "right", "10", "actuator2"))));
    write("hand.urdf", transmittingRobot(motorText("spindle", "base") + motorText("left", "fore") +
                                         motorText("right", "fore")));
    const std::string both = "reactions: [slide, elbow, roll]\n" + more;
    write("read.yaml", both + "urdf_transmissions: all\ncouplings:\n" + belt + actuated);
    write("hand.yaml",
          both + "couplings:\n" + belt +
              "  - {name: lead.spindle, offset: -125, terms: [{name: spindle, factor: 1}, {name: "
              "slide, factor: -250}]}\n"
              "  - {name: wrist.left, offset: 0, terms: [{name: left, factor: 1}, {name: pitch, "
              "factor: -10}, {name: roll, factor: -20}]}\n"
              "  - {name: wrist.right, offset: 0, terms: [{name: right, factor: 1}, {name: pitch, "
              "factor: -10}, {name: roll, factor: 20}]}\n" +
              by_hand);
  }

  // The belt turns the elbow by twice the shoulder.
  static std::vector<MovedJoint> joints() {
    return {swinging("slide", 0.2, 3), swinging("shoulder", 0.4, 2), swinging("elbow", 0.8, 2),
            swinging("pitch", 0.5, 2.5), swinging("roll", 1, 4)};
  }

  const std::vector<HandMotor> motors_{{"spindle", -125, {{"slide", 250}}},
                                       {"left", 0, {{"pitch", 10}, {"roll", 20}}},
                                       {"right", 0, {{"pitch", 10}, {"roll", -20}}}};
};

constexpr char kRates[] =
    "  - {name: belt, rate_only: true, terms: [{name: elbow, factor: 1}, {name: shoulder, factor: "
    "-2}]}\n";
constexpr char kPositions[] =
    "  - {name: belt, offset: 0, terms: [{name: elbow, factor: 1}, {name: shoulder, factor: "
    "-2}]}\n";

TEST_F(OfflineBelts, CouplingsOfRates) {
  writeBelt(kRates, "", "actuated: [slide, shoulder, pitch, roll]\n",
            "actuated: [spindle, shoulder, left, right]\n");
  expectSame(joints(), motors_);
}

TEST_F(OfflineBelts, LoopsWhoseMotionGivesAllJoints) {
  writeBelt(kPositions, "", "actuated: [slide, shoulder, pitch, roll]\n",
            "actuated: [spindle, shoulder, left, right]\n");
  expectSame(joints(), motors_);
}

TEST_F(OfflineBelts, LoopsThatMoveFreely) {
  writeBelt(kPositions, "free_motion: true\n", "actuated: [slide, roll, pitch]\n",
            "actuated: [spindle, left, right]\n");
  expectSame(joints(), motors_);
}

// What is estimated is estimated of the joints.
TEST_F(OfflineBelts, PositionsAlone) {
  writeBelt(kRates, "", "actuated: [slide, shoulder, pitch, roll]\n",
            "actuated: [spindle, shoulder, left, right]\n");
  write("joints.csv", motion(joints(), {}, {"position"}));
  const NumberTable found = parseTable(results(
      "--urdf read.urdf --scene read.yaml --motion joints.csv --positions --loop-tolerance 0.1 "
      "--deviations"));
  ASSERT_EQ(found.rows.size(), 40u);
  const auto at = [&](std::size_t row, const std::string& name) {
    const int column = found.column(name);
    EXPECT_GE(column, 0) << name;
    return found.rows.at(row).at(static_cast<std::size_t>(std::max(column, 0)));
  };
  for (std::size_t row = 0; row < 40; ++row) {
    for (const std::string level : {"velocity.", "acceleration."}) {
      EXPECT_NEAR(at(row, level + "spindle"), 250 * at(row, level + "slide"), 1e-9);
      EXPECT_NEAR(at(row, level + "right"),
                  10 * at(row, level + "pitch") - 20 * at(row, level + "roll"), 1e-9);
    }
    EXPECT_TRUE(std::isfinite(at(row, "deviation.effort.spindle")));
  }
}

TEST_F(OfflineBelts, JointsThatMotionsLackAreNamedStill) {
  writeBelt(kRates, "", "actuated: [slide, shoulder, pitch, roll]\n",
            "actuated: [spindle, shoulder, left, right]\n");
  std::vector<MovedJoint> fewer = joints();
  fewer.erase(fewer.begin() + 3);  // the pitch
  write("joints.csv", motion(fewer, {}, {"position", "velocity", "acceleration"}));
  const Run refused = run("--urdf read.urdf --scene read.yaml --motion joints.csv");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.out, "");
  EXPECT_NE(refused.err.find("joints.csv: too little is given: the motion of "), std::string::npos)
      << refused.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
