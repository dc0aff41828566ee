// Generated code in a node: what the joints must deliver to hold the arm where /joint_states says
// it is.
//
//   06_generated_node joint_states:=/my_arm/joint_states
//
// Joints are found by name once for each order of names; the computation itself knows none.
#include <generated_arm.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <array>
#include <string>

namespace {

constexpr std::size_t kJoints = GENERATED_ARM_COORDINATES;
const std::array<std::string, kJoints> kNames = GENERATED_ARM_COORDINATE_NAMES;

// Positions in the order of the generated code; false when a joint is missing.
bool read(const sensor_msgs::JointState& message, double* q) {
  for (std::size_t i = 0; i < kJoints; ++i) {
    const auto found = std::find(message.name.begin(), message.name.end(), kNames[i]);
    const auto at = static_cast<std::size_t>(found - message.name.begin());
    if (at >= message.name.size() || at >= message.position.size()) return false;
    q[i] = message.position[at];
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "gravity_compensation");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<sensor_msgs::JointState>("gravity_compensation", 10);
  const ros::Subscriber subscriber = node.subscribe<sensor_msgs::JointState>(
      "joint_states", 10, [&publisher](const sensor_msgs::JointState::ConstPtr& message) {
        double q[kJoints], reactions[6 * GENERATED_ARM_REACTIONS];
        const double rest[kJoints] = {};
        if (!read(*message, q)) {
          ROS_WARN_THROTTLE(5, "a joint of the arm is missing in joint_states");
          return;
        }
        sensor_msgs::JointState result;
        result.header = message->header;
        result.name.assign(kNames.begin(), kNames.end());
        result.position.assign(q, q + kJoints);
        result.effort.resize(kJoints);
        generated_arm_compute(q, rest, rest, result.effort.data(), reactions);
        publisher.publish(result);
      });
  ros::spin();
}
