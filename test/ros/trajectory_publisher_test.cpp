#include "ros/trajectory_publisher.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <signal.h>
#include <sys/wait.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

// The node itself is under test, in processes of its own: trajectory_publisher.test starts most of
// them, and NodeProcess those that are refused or stopped.

namespace virtual_work_dynamics {
namespace {

using sensor_msgs::JointState;
using trajectory_msgs::JointTrajectory;

// Closed forms of order 1 computed in another order.
constexpr double kClosedForm = 1e-14;
// Long enough for a loaded machine; reached only by failures.
constexpr double kPatience = 90;

/// Collects the messages of a topic.
template <typename Message>
class Recorder {
 public:
  explicit Recorder(const std::string& topic)
      : subscriber_(node_.subscribe(topic, 10000, &Recorder::take, this)) {}

  /// Waits for `count` messages, then a little for any that should not come.
  const std::vector<Message>& wait(std::size_t count, double after = 0.3) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
    while (ros::ok() && messages_.size() < count && ros::WallTime::now() < end) spin();
    const ros::WallTime late = ros::WallTime::now() + ros::WallDuration(after);
    while (ros::ok() && ros::WallTime::now() < late) spin();
    return messages_;
  }

 private:
  void take(const typename Message::ConstPtr& message) { messages_.push_back(*message); }
  static void spin() { ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01)); }

  ros::NodeHandle node_;
  std::vector<Message> messages_;
  ros::Subscriber subscriber_;
};

/// A publisher node started by the test.
class NodeProcess {
 public:
  explicit NodeProcess(std::vector<std::string> arguments)
      : log_(::testing::TempDir() + "trajectory_publisher_" + std::to_string(getpid()) + ".log") {
    arguments.insert(arguments.begin(), TRAJECTORY_PUBLISHER_NODE);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(&argument[0]);
    pointers.push_back(nullptr);
    process_ = fork();
    if (process_ == 0) {
      const int log = open(log_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
      dup2(log, STDERR_FILENO);
      dup2(log, STDOUT_FILENO);
      execv(pointers[0], pointers.data());
      _exit(127);
    }
  }
  ~NodeProcess() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    unlink(log_.c_str());
  }
  NodeProcess(const NodeProcess&) = delete;
  NodeProcess& operator=(const NodeProcess&) = delete;

  void interrupt() const { kill(process_, SIGINT); }

  /// @returns the exit code; -1 when it was killed by a signal, or does not end.
  int wait() {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
    int status = 0;
    while (waitpid(process_, &status, WNOHANG) == 0) {
      if (ros::WallTime::now() > end) return -1;
      ros::WallDuration(0.02).sleep();
    }
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string output() const {
    std::ostringstream text;
    text << std::ifstream(log_).rdbuf();
    return text.str();
  }

 private:
  std::string log_;
  pid_t process_;
};

/// (5.11) with its derivatives, for the joint with amplitude pi/12 or pi/6.
double cosine(int derivative, std::size_t joint, long double t, long double period = 12) {
  const long double pi = std::acos(-1.0L);
  const long double amplitude = joint == 0 ? pi / 12 : pi / 6;
  const long double rate = 2 * pi / period;
  if (derivative == 0) return static_cast<double>(amplitude * (1 - std::cos(rate * t)));
  if (derivative == 1) return static_cast<double>(amplitude * rate * std::sin(rate * t));
  return static_cast<double>(amplitude * rate * rate * std::cos(rate * t));
}

void expectCosine(const std::vector<double>& values, int derivative, std::int64_t ns,
                  long double period = 12) {
  ASSERT_EQ(values.size(), 2u);
  for (std::size_t j = 0; j < 2; ++j) {
    ASSERT_TRUE(std::isfinite(values[j]));
    const double expected = cosine(derivative, j, static_cast<long double>(ns) / 1e9L, period);
    EXPECT_NEAR(values[j], expected, kClosedForm * std::max(1.0, std::abs(expected)))
        << "derivative " << derivative << " of joint " << j + 1 << " at " << ns << " ns";
  }
}

std::int64_t between(const ros::Time& start, const ros::Time& end) {
  return static_cast<std::int64_t>(end.toNSec()) - static_cast<std::int64_t>(start.toNSec());
}

const std::vector<std::string>& jointNames() {
  static const std::vector<std::string> names = {"joint_1", "joint_2"};
  return names;
}

TEST(TrajectoryPublisher, StreamIsThePapersLawAtItsStamps) {
  Recorder<JointState> recorder("states");
  const auto& states = recorder.wait(2001);
  ASSERT_EQ(states.size(), 2001u);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const JointState& state = states[k];
    const std::int64_t ns = static_cast<std::int64_t>(k) * 1000000;
    EXPECT_EQ(between(states[0].header.stamp, state.header.stamp), ns);
    EXPECT_EQ(state.header.seq, states[0].header.seq + k);
    EXPECT_EQ(state.name, jointNames());
    expectCosine(state.position, 0, ns);
    expectCosine(state.velocity, 1, ns);
    EXPECT_TRUE(state.effort.empty());
  }
}

TEST(TrajectoryPublisher, StampsOfAnUnevenRateAreRoundedOneByOne) {
  Recorder<JointState> recorder("uneven");
  const auto& states = recorder.wait(8);
  ASSERT_EQ(states.size(), 8u);
  for (std::size_t k = 0; k < states.size(); ++k) {
    // round(k 1e9 / 7) in integers.
    const std::int64_t ns = (2 * static_cast<std::int64_t>(k) * 1000000000 + 7) / 14;
    EXPECT_EQ(between(states[0].header.stamp, states[k].header.stamp), ns);
    expectCosine(states[k].position, 0, ns);
    expectCosine(states[k].velocity, 1, ns);
  }
}

TEST(TrajectoryPublisher, LoopGoesOnWithoutASeam) {
  // The law's period is the duration, so the closed form simply goes on.
  Recorder<JointState> recorder("loop");
  const auto& states = recorder.wait(60, 0);
  ASSERT_GE(states.size(), 60u);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const std::int64_t ns = static_cast<std::int64_t>(k) * 25000000;
    EXPECT_EQ(between(states[0].header.stamp, states[k].header.stamp), ns);
    expectCosine(states[k].position, 0, ns, 0.5L);
    EXPECT_TRUE(states[k].velocity.empty());
  }
}

void expectPapersTrajectory(const JointTrajectory& trajectory, std::int64_t rate,
                            std::size_t points) {
  EXPECT_EQ(trajectory.joint_names, jointNames());
  ASSERT_EQ(trajectory.points.size(), points);
  for (std::size_t k = 0; k < points; ++k) {
    const auto& point = trajectory.points[k];
    const std::int64_t ns =
        (2 * static_cast<std::int64_t>(k) * 1000000000 + rate) / (2 * rate);  // rounded
    EXPECT_EQ(point.time_from_start.toNSec(), ns);
    expectCosine(point.positions, 0, ns);
    expectCosine(point.velocities, 1, ns);
    expectCosine(point.accelerations, 2, ns);
    EXPECT_TRUE(point.effort.empty());
  }
}

TEST(TrajectoryPublisher, TrajectoryHasExactAccelerations) {
  const ros::Time before = ros::Time::now();
  Recorder<JointTrajectory> recorder("trajectory");
  const auto& trajectories = recorder.wait(1);
  ASSERT_EQ(trajectories.size(), 1u);
  expectPapersTrajectory(trajectories[0], 70, 421);
  EXPECT_GE(trajectories[0].header.stamp, before);
  EXPECT_LE(trajectories[0].header.stamp, ros::Time::now());
}

TEST(TrajectoryPublisher, TrajectoryWithZeroStampIsRepeated) {
  Recorder<JointTrajectory> recorder("zero_trajectory");
  const auto& trajectories = recorder.wait(3, 0);
  ASSERT_GE(trajectories.size(), 3u);
  for (const JointTrajectory& trajectory : trajectories) {
    EXPECT_TRUE(trajectory.header.stamp.isZero());
    expectPapersTrajectory(trajectory, 10, 6);
  }
}

TEST(TrajectoryPublisher, LoopedTrajectoriesFollowOneSampleAfterTheOther) {
  NodeProcess node({"__name:=looped", "joint_trajectory:=looped", "_message:=joint_trajectory",
                    "_rate:=20", "_duration:=0.4", "_loop:=true"});
  Recorder<JointTrajectory> recorder("looped");
  const auto& trajectories = recorder.wait(3, 0);
  ASSERT_GE(trajectories.size(), 3u);
  for (std::size_t k = 1; k < trajectories.size(); ++k) {
    EXPECT_EQ(between(trajectories[k - 1].header.stamp, trajectories[k].header.stamp), 450000000);
  }
}

TEST(TrajectoryPublisher, LoopedTrajectoriesPause) {
  NodeProcess node({"__name:=paused", "joint_trajectory:=paused", "_message:=joint_trajectory",
                    "_rate:=20", "_duration:=0.4", "_loop:=true", "_loop_pause:=0.25"});
  Recorder<JointTrajectory> recorder("paused");
  const auto& trajectories = recorder.wait(3, 0);
  ASSERT_GE(trajectories.size(), 3u);
  for (std::size_t k = 1; k < trajectories.size(); ++k) {
    EXPECT_EQ(between(trajectories[k - 1].header.stamp, trajectories[k].header.stamp), 700000000);
  }
}

TEST(TrajectoryPublisher, InterruptEndsItQuietly) {
  // A hundred seconds between messages: the wait itself must be interrupted.
  NodeProcess node({"__name:=interrupted", "joint_states:=interrupted", "_rate:=0.01",
                    "_duration:=200", "_loop:=true"});
  Recorder<JointState> recorder("interrupted");
  ASSERT_EQ(recorder.wait(1, 0).size(), 1u);
  node.interrupt();
  EXPECT_EQ(node.wait(), 0) << node.output();
}

TEST(TrajectoryPublisher, EndsByItselfAndSaysWhatItDid) {
  NodeProcess node({"__name:=once", "joint_states:=once", "_rate:=10", "_duration:=0.5",
                    "_wait_for_subscribers:=0", "_start_delay:=0", "_linger:=0.1"});
  EXPECT_EQ(node.wait(), 0);
  EXPECT_NE(node.output().find("published 6 messages on /once"), std::string::npos)
      << node.output();
}

TEST(TrajectoryPublisher, RefusesToStartWithOneLine) {
  struct Refusal {
    std::vector<std::string> arguments;
    std::string part;
  };
  const std::vector<Refusal> refusals = {
      {{"_ratee:=5"}, "unknown parameter /refused_1/ratee (did you mean /refused_1/rate?);"},
      {{"_rate:=fast"}, "parameter /refused_2/rate: expected a number, got the text 'fast'"},
      {{"_law:=cosinus"}, "parameter /refused_3/law: expected cosine"},
      {{"_joints:=a"}, "parameter /refused_4/joints: expected a list of texts"},
      {{"_law:=table", "_file:=/does/not/exist.csv"},
       "parameter /refused_5/file: /does/not/exist.csv: "},
      {{"nonsense"}, "unknown argument nonsense"},
      // Before there is a node.
      {{"joint_states:=joint%states"}, "[joint%states]"},
      {{"__master:=nowhere"}, "__master: expected an address like http://localhost:11311"},
      {{"_rate%:=5"}, "[~rate%]"},
  };
  int count = 0;
  for (const Refusal& refusal : refusals) {
    std::vector<std::string> arguments = refusal.arguments;
    // Each node has its own name, as private parameters outlive their node.
    arguments.push_back("__name:=refused_" + std::to_string(++count));
    NodeProcess node(arguments);
    EXPECT_EQ(node.wait(), 1) << refusal.part;
    const std::string output = node.output();
    EXPECT_NE(output.find("FATAL"), std::string::npos) << output;
    EXPECT_NE(output.find(refusal.part), std::string::npos) << output;
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
  }
}

TEST(TrajectoryPublisher, HelpNamesEveryParameter) {
  NodeProcess node({"--help"});
  EXPECT_EQ(node.wait(), 0);
  std::ifstream file(VWD_SOURCE_DIR "/config/trajectory_publisher.yaml");
  int count = 0;
  std::string above;  // name of a map that the next lines are in
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    const std::size_t colon = line.find(':');
    if (line.empty() || line[begin] == '#' || colon == std::string::npos) continue;
    if (begin == 0) above.clear();
    const std::string name = above + line.substr(begin, colon - begin);
    if (colon + 1 == line.size()) {
      above = name + "/";
      continue;
    }
    EXPECT_NE(node.output().find("  ~" + name + " "), std::string::npos) << line;
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace virtual_work_dynamics

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "trajectory_publisher_test");
  const ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
