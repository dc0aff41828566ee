#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "ros/private_parameters.h"
#include "virtual_work_dynamics/urdf_reader.h"

// Time from publishing a joint state to receiving what a node makes of it, for
// inverse_dynamics_node beside copy_node.
//
// Each joint state goes to one of the two, in turn, half a period apart. Sent to both at once they
// would wake up together and fight for the cores, and the figure would be who wins; in turn, each
// answers on an idle machine, and whatever else the machine does meets both alike.

namespace virtual_work_dynamics {
namespace {

using Clock = std::chrono::steady_clock;
using sensor_msgs::JointState;
using std::chrono::nanoseconds;

constexpr char kUsage[] =
    R"(usage: latency_probe [--help] [name:=value ...]

Measures the time from publishing a joint state to receiving the result, and prints it.

publishes   ~to_inverse_dynamics     sensor_msgs/JointState  for inverse_dynamics_node
            ~to_copy                 sensor_msgs/JointState  for copy_node, half a period later
subscribes  inverse_dynamics/effort  sensor_msgs/JointState
            copy/copy                sensor_msgs/JointState

parameters
  ~robot     path of the robot's URDF, for the names of the joints (needed)
  ~rate      joint states per second for each node, Hz (1000)
  ~seconds   length of the measurement, s (20)
  inverse_dynamics/estimator/lag  as inverse_dynamics_node has it, s (needed)
)";

constexpr std::uint32_t kQueue = 20000;  // messages
// Caches, memory pools and the nodes' plans are ready after this; not measured.
constexpr double kWarmUp = 1;                             // s
constexpr double kPatience = 30;                          // s for the nodes to connect
constexpr std::chrono::milliseconds kLastAnswers{1000};   // after the last joint state
constexpr std::chrono::milliseconds kSettle{500};         // after the last connection
constexpr std::chrono::milliseconds kConnectionCheck{5};  // how often to look for connections
constexpr double kAmplitude = 0.1;                        // rad or m
constexpr double kFrequency = 0.5;                        // Hz
constexpr double kTwoPi = 6.283185307179586;
constexpr std::size_t kParts = 5;  // of the measurement, to show how steady it is

struct Settings {
  std::vector<std::string> joints;
  double rate = 0;     // Hz
  double seconds = 0;  // s
  double lag = 0;      // s

  std::int64_t stepNs() const { return static_cast<std::int64_t>(std::llround(1e9 / rate)); }
  /// Samples that an answer's stamp is behind the newest one.
  std::int64_t lagSamples() const { return (std::llround(lag * 1e9) + stepNs() - 1) / stepNs(); }
  std::size_t warmUp() const { return static_cast<std::size_t>(kWarmUp * rate) + 128; }
  std::size_t samples() const {
    return warmUp() + static_cast<std::size_t>(std::llround(seconds * rate));
  }
};

double estimatorLag() {
  double lag = 0;
  const std::string key = "inverse_dynamics/estimator/lag";
  if (!ros::param::get(key, lag)) throw ParameterError("parameter " + key + ": not set");
  return lag;
}

Settings readSettings(PrivateParameters& parameters) {
  Settings settings;
  const std::string robot = parameters.text("robot", "");
  settings.rate = parameters.number("rate", 1000);
  settings.seconds = parameters.number("seconds", 20);
  parameters.refuseUnknown();
  if (robot.empty()) throw parameterError("robot", "not set");
  if (!(settings.rate >= 1 && settings.rate <= 1e5)) throw parameterError("rate", "not 1 to 1e5");
  if (!(settings.seconds >= 1)) throw parameterError("seconds", "less than 1");
  settings.joints = readUrdfFile(robot).coordinateNames();
  settings.lag = estimatorLag();
  return settings;
}

/// The way to one node and back.
class Route {
 public:
  /// @param lag how many samples behind the newest one an answer's stamp is.
  Route(const std::string& input, const std::string& output, const Settings& settings,
        std::int64_t lag)
      : lag_(lag),
        step_ns_(settings.stepNs()),
        sent_(settings.samples()),
        answered_(settings.samples()) {
    state_.name = settings.joints;
    state_.position.resize(settings.joints.size());
    state_.velocity.resize(settings.joints.size());
    // As long as the results, which have efforts.
    state_.effort.resize(settings.joints.size());
    publisher_ = ros::NodeHandle("~").advertise<JointState>(input, kQueue);
    subscriber_ = ros::NodeHandle().subscribe(output, kQueue, &Route::receive, this,
                                              ros::TransportHints().tcpNoDelay());
  }

  bool connected() const {
    return publisher_.getNumSubscribers() > 0 && subscriber_.getNumPublishers() > 0;
  }
  void start(const ros::Time& first_stamp) {
    first_stamp_ns_ = static_cast<std::int64_t>(first_stamp.toNSec());
  }

  /// Sets the state to that of sample k, before the time at which it is to be sent.
  void prepare(std::size_t k) {
    const std::int64_t offset = static_cast<std::int64_t>(k) * step_ns_;
    state_.header.stamp.fromNSec(static_cast<std::uint64_t>(first_stamp_ns_ + offset));
    const double phase = kTwoPi * kFrequency * 1e-9 * static_cast<double>(offset);
    for (std::size_t i = 0; i < state_.position.size(); ++i) {
      state_.position[i] = kAmplitude * std::sin(phase + static_cast<double>(i));
      state_.velocity[i] =
          kAmplitude * kTwoPi * kFrequency * std::cos(phase + static_cast<double>(i));
    }
  }
  void publish(std::size_t k) {
    sent_[k] = Clock::now().time_since_epoch().count();
    publisher_.publish(state_);
  }

  /// Latencies in ns of the samples from `first` to before `last` that were answered.
  std::vector<std::int64_t> latencies(std::size_t first, std::size_t last) const {
    std::vector<std::int64_t> result;
    for (std::size_t k = first; k < last; ++k) {
      if (answered_[k] != 0) result.push_back(answered_[k] - sent_[k]);
    }
    std::sort(result.begin(), result.end());
    return result;
  }
  /// How many samples should have been answered but were not.
  std::size_t unanswered() const {
    std::size_t count = 0;
    for (auto k = static_cast<std::size_t>(lag_); k < answered_.size(); ++k) {
      count += answered_[k] == 0;
    }
    return count;
  }

 private:
  void receive(const JointState::ConstPtr& answer) {
    const std::int64_t now = Clock::now().time_since_epoch().count();
    const auto stamp = static_cast<std::int64_t>(answer->header.stamp.toNSec());
    // Which sample made the node answer.
    const auto k = static_cast<std::size_t>((stamp - first_stamp_ns_) / step_ns_ + lag_);
    if (k < answered_.size()) answered_[k] = now;
  }

  const std::int64_t lag_;
  const std::int64_t step_ns_;
  std::atomic<std::int64_t> first_stamp_ns_{0};
  std::vector<std::atomic<std::int64_t>> sent_;      // ns, steady clock
  std::vector<std::atomic<std::int64_t>> answered_;  // 0: not yet
  JointState state_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

void waitForNodes(const Route& dynamics, const Route& copy) {
  const auto end = Clock::now() + std::chrono::duration<double>(kPatience);
  while (ros::ok() && !(dynamics.connected() && copy.connected())) {
    if (Clock::now() > end) {
      throw Error(std::string("no connection to ") +
                  (dynamics.connected() ? "copy_node" : "inverse_dynamics_node") + " within 30 s");
    }
    std::this_thread::sleep_for(kConnectionCheck);
  }
  std::this_thread::sleep_for(kSettle);
}

void play(const Settings& settings, Route& dynamics, Route& copy) {
  const ros::Time stamp = ros::Time::now();
  dynamics.start(stamp);
  copy.start(stamp);
  const Clock::time_point start = Clock::now();
  const nanoseconds half_step(settings.stepNs() / 2);
  for (std::size_t k = 0; k < settings.samples() && ros::ok(); ++k) {
    const Clock::time_point time = start + static_cast<std::int64_t>(2 * k) * half_step;
    dynamics.prepare(k);
    std::this_thread::sleep_until(time);
    dynamics.publish(k);
    copy.prepare(k);
    std::this_thread::sleep_until(time + half_step);
    copy.publish(k);
  }
  std::this_thread::sleep_for(kLastAnswers);
}

/// The smallest value that the given share of all values does not exceed; NaN when there is none.
double quantile(const std::vector<std::int64_t>& sorted, double share) {
  if (sorted.empty()) return std::nan("");
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return 1e-3 * static_cast<double>(sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1]);
}

void printRow(const char* name, const std::vector<std::int64_t>& latencies, const Route& route) {
  std::printf("%-22s %10.1f %10.1f %10.1f %10zu %10zu\n", name, quantile(latencies, 0.5),
              quantile(latencies, 0.99), quantile(latencies, 1), latencies.size(),
              route.unanswered());
}

void printReport(const Settings& settings, const Route& dynamics, const Route& copy) {
  const std::size_t first = settings.warmUp();
  const std::size_t last = settings.samples();
  std::printf("%-22s %10s %10s %10s %10s %10s\n", "latency (us)", "median", "p99", "worst",
              "samples", "unanswered");
  const auto of_dynamics = dynamics.latencies(first, last);
  const auto of_copy = copy.latencies(first, last);
  printRow("inverse_dynamics_node", of_dynamics, dynamics);
  printRow("copy_node", of_copy, copy);
  std::printf("ratio of medians       %10.3f   in %zu parts of the run:",
              quantile(of_dynamics, 0.5) / quantile(of_copy, 0.5), kParts);
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t from = first + (last - first) * part / kParts;
    const std::size_t to = first + (last - first) * (part + 1) / kParts;
    std::printf(" %.3f", quantile(dynamics.latencies(from, to), 0.5) /
                             quantile(copy.latencies(from, to), 0.5));
  }
  std::printf("\n");
}

void run() {
  PrivateParameters parameters(ros::NodeHandle("~"));
  const Settings settings = readSettings(parameters);
  Route dynamics("to_inverse_dynamics", "inverse_dynamics/effort", settings, settings.lagSamples());
  Route copy("to_copy", "copy/copy", settings, 0);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  waitForNodes(dynamics, copy);
  play(settings, dynamics, copy);
  spinner.stop();
  if (!ros::ok()) throw Error("interrupted");
  printReport(settings, dynamics, copy);
}

}  // namespace
}  // namespace virtual_work_dynamics

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::fputs(kUsage, stdout);
      return 0;
    }
  }
  ros::init(argc, argv, "latency_probe");
  const ros::NodeHandle node;
  try {
    if (argc > 1) throw ParameterError(std::string("unknown argument ") + argv[1]);
    run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
