#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <string>

// The yardstick for inverse_dynamics_node: what a node costs that does nothing with a joint state
// but copy it. Queues, transport hints, the count of late results and the thread that reports it
// are as in that node.

namespace {

constexpr char kUsage[] =
    R"(usage: copy_node [--help] [name:=value ...]

Publishes a copy of every joint state at once.

subscribes  joint_states  sensor_msgs/JointState
publishes   ~copy         sensor_msgs/JointState
            /diagnostics  diagnostic_msgs/DiagnosticArray  joint states received, late copies
)";

constexpr std::uint32_t kInputQueue = 1000;    // messages
constexpr std::uint32_t kOutputQueue = 20000;  // messages
const ros::Duration kLateThreshold(0.001);     // from receipt to the published copy
const ros::WallDuration kDiagnosticPeriod(1.0);

class CopyNode {
 public:
  CopyNode()
      : publisher_(private_node_.advertise<sensor_msgs::JointState>("copy", kOutputQueue)),
        spinner_(1, &diagnostic_queue_) {
    diagnostics_.setHardwareID("none");
    diagnostics_.add("copies", this, &CopyNode::report);
    ros::NodeHandle diagnostic_node;
    diagnostic_node.setCallbackQueue(&diagnostic_queue_);
    timer_ = diagnostic_node.createWallTimer(
        kDiagnosticPeriod, [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
    spinner_.start();
    subscriber_ = node_.subscribe("joint_states", kInputQueue, &CopyNode::receive, this,
                                  ros::TransportHints().tcpNoDelay());
  }

 private:
  void receive(const ros::MessageEvent<const sensor_msgs::JointState>& event) {
    const sensor_msgs::JointState copy = *event.getConstMessage();
    publisher_.publish(copy);
    received_.fetch_add(1, std::memory_order_relaxed);
    if (ros::Time::now() - event.getReceiptTime() > kLateThreshold) {
      late_.fetch_add(1, std::memory_order_relaxed);
    }
  }

  void report(diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
    status.add("joint states received", received_.load());
    status.add("late outputs", late_.load());
  }

  ros::NodeHandle node_;
  ros::NodeHandle private_node_{"~"};
  std::atomic<std::uint64_t> received_{0};
  std::atomic<std::uint64_t> late_{0};
  ros::Publisher publisher_;
  diagnostic_updater::Updater diagnostics_;
  ros::CallbackQueue diagnostic_queue_;
  ros::WallTimer timer_;
  ros::AsyncSpinner spinner_;
  ros::Subscriber subscriber_;
};

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::fputs(kUsage, stdout);
      return 0;
    }
  }
  ros::init(argc, argv, "copy");
  CopyNode node;
  ros::spin();
  return 0;
}
