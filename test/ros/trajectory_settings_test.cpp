#include "ros/trajectory_settings.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

const double kPi = std::acos(-1.0);
// Values of order 1 computed in another order.
constexpr double kClosedForm = 1e-14;

/// Converts YAML as `rosparam load` does.
XmlRpcValue parameter(const YAML::Node& node) {
  XmlRpcValue value;
  if (node.IsSequence()) {
    value.setSize(static_cast<int>(node.size()));
    for (int i = 0; i < value.size(); ++i) value[i] = parameter(node[i]);
    return value;
  }
  if (node.IsMap()) {
    for (const auto& member : node)
      value[member.first.as<std::string>()] = parameter(member.second);
    return value;
  }
  int integer = 0;
  double number = 0;
  bool boolean = false;
  const bool quoted = node.Tag() == "!";
  if (!quoted && YAML::convert<int>::decode(node, integer)) return XmlRpcValue(integer);
  if (!quoted && YAML::convert<double>::decode(node, number)) return XmlRpcValue(number);
  if (!quoted && YAML::convert<bool>::decode(node, boolean)) return XmlRpcValue(boolean);
  return XmlRpcValue(node.as<std::string>());
}

TrajectorySettings settingsOfTree(const XmlRpcValue& tree) {
  PrivateParameters parameters(tree);
  return readTrajectorySettings(parameters);
}

TrajectorySettings settingsOf(const std::string& yaml) {
  return settingsOfTree(parameter(YAML::Load(yaml)));
}

Motion motionAt(const TrajectorySettings& settings, double t) {
  Motion motion;
  settings.law->evaluate(t, motion);
  return motion;
}

void expectRefused(const std::string& yaml, const std::string& part) {
  try {
    settingsOf(yaml);
    ADD_FAILURE() << "not refused: " << yaml;
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

/// A CSV file that exists as long as this object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) : path_(::testing::TempDir() + "motion.csv") {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TEST(TrajectorySettings, DefaultsPlayThePapersPendulum) {
  const TrajectorySettings settings = settingsOfTree(XmlRpcValue());
  EXPECT_EQ(settings.joints, (std::vector<std::string>{"joint_1", "joint_2"}));
  EXPECT_EQ(settings.law->duration(), 6);
  // (5.11): 2 pi / 12 and 2 pi / 6 at the end.
  const Motion end = motionAt(settings, 6);
  EXPECT_NEAR(end.q[0], kPi / 6, kClosedForm);
  EXPECT_NEAR(end.q[1], kPi / 3, kClosedForm);
  EXPECT_NEAR(end.qdd[1], -kPi / 6 * kPi * kPi / 36, kClosedForm);
}

TEST(TrajectorySettings, TheConfigurationFileHoldsAllDefaults) {
  const YAML::Node file = YAML::LoadFile(VWD_SOURCE_DIR "/config/trajectory_publisher.yaml");
  const TrajectorySettings read = settingsOfTree(parameter(file));
  const TrajectorySettings defaults = settingsOfTree(XmlRpcValue());
  EXPECT_EQ(read.joints, defaults.joints);
  EXPECT_EQ(read.rate, defaults.rate);
  EXPECT_EQ(read.as_trajectory, defaults.as_trajectory);
  EXPECT_EQ(read.velocities, defaults.velocities);
  EXPECT_EQ(read.zero_stamp, defaults.zero_stamp);
  EXPECT_EQ(read.loop, defaults.loop);
  EXPECT_EQ(read.loop_pause, defaults.loop_pause);
  EXPECT_EQ(read.wait_for_subscribers, defaults.wait_for_subscribers);
  EXPECT_EQ(read.start_delay, defaults.start_delay);
  EXPECT_EQ(read.linger, defaults.linger);
  EXPECT_EQ(read.root.source, defaults.root.source);
  EXPECT_EQ(read.root.inertial_frame, defaults.root.inertial_frame);
  EXPECT_EQ(read.root.link, defaults.root.link);
  EXPECT_EQ(read.root.gravity, defaults.root.gravity);
  EXPECT_EQ(read.law->duration(), defaults.law->duration());
  EXPECT_EQ(motionAt(read, 1.7).q, motionAt(defaults, 1.7).q);
  EXPECT_EQ(motionAt(read, 1.7).qdd, motionAt(defaults, 1.7).qdd);
  // The default law does not use the parameters of the sweep.
  YAML::Node sweep = YAML::Clone(file);
  sweep["law"] = "sine_sweep";
  EXPECT_EQ(motionAt(settingsOfTree(parameter(sweep)), 1.7).q,
            motionAt(settingsOf("{law: sine_sweep}"), 1.7).q);
  // Every parameter is in the file: the refusal lists the known ones.
  try {
    settingsOf("{nonsense: 1}");
    ADD_FAILURE() << "not refused";
  } catch (const ParameterError& error) {
    std::string known = error.what();
    known = known.substr(known.find("known are ") + 10) + ", ";
    std::size_t count = 0;
    for (std::size_t i = 0; i < known.size(); i = known.find(", ", i) + 2, ++count) {
      const std::string name = known.substr(i, known.find(", ", i) - i);
      const std::size_t slash = name.find('/');
      const YAML::Node value = file[name.substr(0, slash)];
      EXPECT_TRUE(slash == std::string::npos ? value.IsDefined()
                                             : value[name.substr(slash + 1)].IsDefined())
          << name;
    }
    EXPECT_EQ(count, file.size() - 1 + file["root"].size());
  }
}

TEST(TrajectorySettings, EverythingCanBeSet) {
  const TrajectorySettings settings = settingsOf(
      "{joints: [a], amplitudes: [2], period: 4, duration: 3, rate: '2e1', velocities: false,"
      " message: joint_trajectory, stamp: zero, loop: true, loop_pause: 1.5,"
      " wait_for_subscribers: 0,"
      " start_delay: 0.25, linger: 0}");
  EXPECT_EQ(settings.joints, std::vector<std::string>{"a"});
  EXPECT_EQ(settings.law->duration(), 3);
  EXPECT_NEAR(motionAt(settings, 2).q[0], 4, kClosedForm);
  EXPECT_EQ(settings.rate, 20);
  EXPECT_FALSE(settings.velocities);
  EXPECT_TRUE(settings.as_trajectory);
  EXPECT_TRUE(settings.zero_stamp);
  EXPECT_TRUE(settings.loop);
  EXPECT_EQ(settings.loop_pause, 1.5);
  EXPECT_EQ(settings.wait_for_subscribers, 0);
  EXPECT_EQ(settings.start_delay, 0.25);
  EXPECT_EQ(settings.linger, 0);
}

TEST(TrajectorySettings, SineSweep) {
  const TrajectorySettings settings = settingsOf(
      "{law: sine_sweep, joints: [a], amplitudes: [2], start_frequency: 1, end_frequency: 3,"
      " duration: 2}");
  EXPECT_EQ(settings.law->duration(), 2);
  EXPECT_NEAR(motionAt(settings, 0).qd[0], 4 * kPi, 100 * kClosedForm);
  EXPECT_NEAR(motionAt(settings, 2).qd[0], 12 * kPi, 100 * kClosedForm);
}

TEST(TrajectorySettings, MinimumJerkThroughViaPoints) {
  const TrajectorySettings settings = settingsOf(
      "{law: minimum_jerk, via_points: [{time: 1, positions: [0, 1]},"
      " {time: 3, positions: [1, '5']}]}");
  EXPECT_EQ(settings.law->duration(), 2);
  EXPECT_EQ(motionAt(settings, 0).q, Eigen::Vector2d(0, 1));
  EXPECT_NEAR(motionAt(settings, 1).q[1], 3, kClosedForm);
  EXPECT_EQ(motionAt(settings, 2).q, Eigen::Vector2d(1, 5));
}

TEST(TrajectorySettings, TableOfNamedJointsOrOfAll) {
  const TemporaryFile file("time,position.b,position.a\n2,1,10\n3,2,20\n");
  const std::string common = "law: table, file: '" + file.path() + "'";
  const TrajectorySettings named = settingsOf("{joints: [a], " + common + "}");
  EXPECT_EQ(named.joints, std::vector<std::string>{"a"});
  EXPECT_EQ(named.law->duration(), 1);
  EXPECT_EQ(motionAt(named, 0).q[0], 10);
  const TrajectorySettings all = settingsOf("{joints: [], " + common + "}");
  EXPECT_EQ(all.joints, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(motionAt(all, 1).q, Eigen::Vector2d(2, 20));
}

/// The angle at the end of a table of one joint, the wheel.
double wheelAtTheEnd(const std::string& rows, const RobotSource& robot) {
  const TemporaryFile file("time,position.wheel\n" + rows);
  PrivateParameters parameters(
      parameter(YAML::Load("{joints: [], law: table, file: '" + file.path() + "'}")));
  const TrajectorySettings settings = readTrajectorySettings(parameters, robot);
  return motionAt(settings, settings.law->duration()).q[0];
}

TEST(TrajectorySettings, PositionsOfATableThatWrapAreUnwrapped) {
  std::vector<Link> links(2);
  std::vector<Joint> joints(1);
  joints[0].name = "wheel";
  joints[0].type = JointType::kContinuous;
  joints[0].child_link = 1;
  joints[0].coordinate = 0;
  links[1].parent_joint = 0;
  const Mechanism robot("robot", links, joints);
  // A row a second at 3 rad/s: only a description tells that the wheel turns on.
  const std::string slow = "0,3\n1,-0.28318530717958623\n";
  const auto described = [&robot] { return robot; };
  EXPECT_NEAR(wheelAtTheEnd(slow, described), 6, kClosedForm);
  EXPECT_LT(wheelAtTheEnd(slow, {}), 0);
  EXPECT_LT(wheelAtTheEnd(slow, [] { return std::nullopt; }), 0) << "none is described";
  // In ten milliseconds nothing turns back as far.
  EXPECT_NEAR(wheelAtTheEnd("0,3\n0.01,-3.26\n", {}), 2 * kPi - 3.26, kClosedForm);
}

TEST(TrajectorySettings, OnlyATableAsksForTheRobot) {
  PrivateParameters parameters(parameter(YAML::Load("{law: cosine}")));
  const TrajectorySettings settings =
      readTrajectorySettings(parameters, []() -> std::optional<Mechanism> {
        ADD_FAILURE() << "asked for";
        return std::nullopt;
      });
  EXPECT_NE(settings.law, nullptr);
}

TEST(TrajectorySettings, RefusalsNameTheParameter) {
  expectRefused("{rates: 5}", "unknown parameter ~rates (did you mean ~rate?);");
  expectRefused("{rate: fast}", "~rate: expected a number");
  expectRefused("{rate: 0}", "~rate: expected more than 0 and up to 1e6 Hz, got 0");
  expectRefused("{rate: 2.0e6}", "~rate");
  expectRefused("{joints: a}", "~joints: expected a list of texts");
  expectRefused("{joints: []}", "~joints: expected at least one");
  expectRefused("{joints: [a, a]}", "~joints: 'a' is named twice");
  expectRefused("{joints: [a, '']}", "~joints: a name is empty");
  expectRefused("{joints: [a, b, c]}", "~amplitudes: expected a number for each of the 3 joints");
  expectRefused("{joints: [a]}", "~amplitudes: expected a number for each of the 1 joints, got 2");
  expectRefused("{amplitudes: [1, x]}", "~amplitudes[1]");
  expectRefused("{law: cosinus}", "~law: expected cosine, sine_sweep, minimum_jerk or table");
  expectRefused("{law: 3}", "~law");
  expectRefused("{period: -1}", "~period: expected more than 0 s, got -1");
  expectRefused("{duration: 0}", "~duration: expected more than 0 s, got 0");
  expectRefused("{duration: 1.0e-7}",
                "~duration: the motion must last from 1e-6 to 1e9 s, its duration is 1e-07 s");
  expectRefused("{duration: 2.0e9}", "its duration is 2e+09 s");
  expectRefused("{law: sine_sweep, end_frequency: -1}", "~end_frequency: expected 0 Hz or more");
  expectRefused("{message: joint_stat}", "~message: expected joint_state or joint_trajectory");
  expectRefused("{stamp: later}", "~stamp: expected now or zero");
  expectRefused("{stamp: zero}", "~stamp: only a joint_trajectory");
  expectRefused("{velocities: 1}", "~velocities: expected true or false");
  expectRefused("{loop: 'no'}", "~loop: expected true or false");
  expectRefused("{message: joint_trajectory, loop_pause: -1}", "~loop_pause: expected 0 to 1e9 s");
  expectRefused("{loop_pause: 1}", "~loop_pause: only a joint_trajectory can pause");
  expectRefused("{wait_for_subscribers: -1}", "~wait_for_subscribers");
  expectRefused("{wait_for_subscribers: 0.5}", "~wait_for_subscribers: expected an integer");
  expectRefused("{start_delay: -1}", "~start_delay: expected 0 to 1e9 s, got -1");
  expectRefused("{linger: -1}", "~linger");
  expectRefused("{message: joint_trajectory, duration: 60, rate: 1.0e+6}",
                "~rate: a trajectory of 60000001 points");
}

TEST(TrajectorySettings, RefusalsOfViaPointsNameThePoint) {
  const std::string law = "{law: minimum_jerk, via_points: ";
  expectRefused("{law: minimum_jerk}", "~via_points: expected a list");
  expectRefused(law + "[]}", "~via_points: a minimum-jerk motion needs at least two");
  expectRefused(law + "[{time: 0, positions: [0, 0]}, 3]}", "~via_points[1]: expected {time");
  expectRefused(law + "[{time: 0, position: [0, 0]}]}", "~via_points[0]: expected {time");
  expectRefused(law + "[{time: 0, positions: [0, 0], velocities: [0, 0]}]}", "~via_points[0]");
  expectRefused(law + "[{time: 0, positions: [0]}]}",
                "~via_points[0]/positions: expected a number for each of the 2 joints, got 1");
  expectRefused(law + "[{time: soon, positions: [0, 0]}]}", "~via_points[0]/time: expected a num");
  expectRefused(law + "[{time: 1, positions: [0, 0]}, {time: 1, positions: [1, 1]}]}",
                "~via_points: knot 2");
}

TEST(TrajectorySettings, RefusalsOfTables) {
  expectRefused("{law: table}", "~file: the law `table` needs a file");
  expectRefused("{law: table, file: /does/not/exist.csv}", "~file: /does/not/exist.csv");
  const TemporaryFile file("time,position.joint_1,position.joint_2\n2,1,10\n");
  expectRefused("{law: table, loop: true, file: '" + file.path() + "'}",
                "~loop: a motion of a single instant");
  const TemporaryFile other("time,position.a\n0,1\n1,1\n");
  expectRefused("{law: table, file: '" + other.path() + "'}", "~file: " + other.path());
}

}  // namespace
}  // namespace virtual_work_dynamics
