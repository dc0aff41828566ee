// Joint states, joints that turn freely, trajectories, wrenches, motions of the root and
// measurements of its IMU whose values come from bytes, up to the core's motions.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "fuzz_target.h"
#include "ros/free_joints.h"
#include "ros/imu_conversion.h"
#include "ros/joint_state_conversion.h"
#include "ros/private_name.h"
#include "ros/root_conversion.h"
#include "ros/trajectory_conversion.h"
#include "ros/wrench_conversion.h"
#include "virtual_work_dynamics/urdf_reader.h"

using namespace virtual_work_dynamics;

// As it is where there is no node; the real one needs roscpp.
std::string virtual_work_dynamics::privateName(const std::string& name) {
  return "~" + name;
}

namespace {

const Mechanism& robot() {
  static const Mechanism robot = readUrdfFile(VWD_SOURCE_DIR "/test/fuzz/gripper.urdf");
  return robot;
}

// Makes values of messages out of bytes. roscpp's own reader is left out: it takes as much memory
// as a length in the bytes says, before it looks whether they are there.
class Values {
 public:
  Values(const std::uint8_t* data, std::size_t size) : data_(data, size) {}

  bool yes() { return data_.ConsumeBool(); }
  std::size_t count(std::size_t most) { return data_.ConsumeIntegralInRange<std::size_t>(0, most); }
  template <typename Integer>
  Integer integer() {
    return data_.ConsumeIntegral<Integer>();
  }
  // Any number, also NaN and infinity, but mostly those of robots.
  double number() {
    if (yes()) return data_.ConsumeFloatingPointInRange<double>(-10, 10);
    const auto bits = data_.ConsumeIntegral<std::uint64_t>();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::vector<double> numbers(std::size_t usual) {
    std::vector<double> values(yes() ? usual : count(4));
    for (double& value : values) value = number();
    return values;
  }
  std::vector<std::string> names() {
    std::vector<std::string> names(count(4));
    for (std::string& name : names) {
      name = yes() ? std::string(1, static_cast<char>('a' + count(3)))
                   : data_.ConsumeRandomLengthString(8);
    }
    return names;
  }

 private:
  FuzzedDataProvider data_;
};

void requireWord(const Rejection& rejection) {
  if (rejection.text.empty()) failFuzz("dropped without a word");
}

void useJointStates(Values& values) {
  JointStateConversion conversion(robot());
  MotionEstimator estimator(robot(), EstimatorSettings());
  Motion motion(static_cast<Eigen::Index>(robot().coordinates().size()));
  sensor_msgs::JointState message;
  message.header.stamp.sec = values.integer<std::uint32_t>();
  for (std::size_t left = values.count(32); left > 0; --left) {
    if (message.name.empty() || !values.yes()) message.name = values.names();
    message.position = values.numbers(message.name.size());
    message.velocity = values.numbers(message.name.size());
    const std::uint64_t stamp =
        message.header.stamp.toNSec() + std::uint64_t{values.integer<std::uint16_t>()} * 1000;
    message.header.stamp.fromNSec(std::min(stamp, ros::TIME_MAX.toNSec()));
    JointSample sample;
    if (const auto rejection = conversion.convert(message, sample)) {
      requireWord(*rejection);
      continue;
    }
    estimator.push(sample.stamp_ns, sample.coordinates, sample.q, sample.qd, sample.count);
    while (estimator.ready()) estimator.evaluate(motion);
  }
}

trajectory_msgs::JointTrajectory trajectoryOf(Values& values) {
  trajectory_msgs::JointTrajectory message;
  message.joint_names = values.names();
  message.points.resize(values.count(8));
  std::int64_t time = 0;
  for (trajectory_msgs::JointTrajectoryPoint& point : message.points) {
    point.positions = values.numbers(message.joint_names.size());
    if (values.yes()) point.velocities = values.numbers(message.joint_names.size());
    if (values.yes()) point.accelerations = values.numbers(message.joint_names.size());
    if (values.yes()) point.effort = values.numbers(message.joint_names.size());
    time += values.yes() ? 1 + values.integer<std::uint32_t>() % 2000000000
                         : values.integer<std::int32_t>();
    point.time_from_start.fromNSec(time);
  }
  return message;
}

void useTrajectory(Values& values) {
  const trajectory_msgs::JointTrajectory message = trajectoryOf(values);
  MotionEstimator estimator(robot(), EstimatorSettings());
  for (const double sampling : {0.0, 50.0}) {
    const TrajectoryConversion conversion(robot(), false, {true, true}, sampling);
    TrajectoryMotion motion;
    auto rejection = conversion.convert(message, 1000000000, estimator, motion);
    if (!rejection) rejection = conversion.complete(message, motion);
    if (rejection) {
      requireWord(*rejection);
      continue;
    }
    if (!motion.table.positions.allFinite()) failFuzz("a position that is not finite");
    Motion sample;
    for (std::size_t i = 0; motion.samples && i < motion.samples->count() && i < 100; ++i) {
      motion.samples->evaluate(i, sample);
    }
    withEfforts(message, motion, motion.table.positions);
  }
}

void useWrenches(Values& values) {
  Scene scene;
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].name = "push";
  scene.applied_wrenches[0].link = robot().links().back().name;
  scene.applied_wrenches[0].live = true;
  LiveWrenches wrenches(robot(), scene, 0.1);
  WrenchConversion conversion(robot(), values.yes() ? "" : "left/", wrenches);
  Load load(scene);
  geometry_msgs::WrenchStamped message;
  for (std::size_t left = values.count(32); left > 0; --left) {
    const std::size_t link = values.count(robot().links().size());
    message.header.frame_id = link < robot().links().size() ? robot().links()[link].name
                              : values.names().empty()      ? ""
                                                            : "a";
    message.header.stamp.sec = values.yes() ? values.integer<std::uint32_t>() : 7;
    message.header.stamp.nsec = values.integer<std::uint32_t>() % 1000000000;
    geometry_msgs::Vector3& force = message.wrench.force;
    geometry_msgs::Vector3& torque = message.wrench.torque;
    for (double* number : {&force.x, &force.y, &force.z, &torque.x, &torque.y, &torque.z}) {
      *number = values.number();
    }
    if (const auto rejection = conversion.take(0, message)) requireWord(*rejection);
    const auto stamp = static_cast<std::int64_t>(message.header.stamp.toNSec());
    if (wrenches.read(stamp + values.integer<std::int32_t>())) continue;
    wrenches.getLoad(Motion(static_cast<Eigen::Index>(robot().coordinates().size())), load);
  }
}

geometry_msgs::Transform transformOf(Values& values) {
  geometry_msgs::Transform transform;
  transform.rotation.w = 1;
  if (values.yes()) {
    for (double* number : {&transform.rotation.x, &transform.rotation.y, &transform.rotation.z,
                           &transform.rotation.w}) {
      *number = values.number();
    }
  }
  transform.translation.x = values.number();
  return transform;
}

geometry_msgs::Twist twistOf(Values& values) {
  geometry_msgs::Twist twist;
  twist.linear.y = values.number();
  twist.angular.z = values.number();
  return twist;
}

void useRootPoses(Values& values) {
  RootConversion conversion("odom", "a");
  RootEstimator estimator(EstimatorSettings(), 100000000);
  nav_msgs::Odometry message;
  message.header.stamp.sec = values.integer<std::uint32_t>();
  for (std::size_t left = values.count(32); left > 0; --left) {
    message.header.frame_id = values.count(8) == 0 ? "map" : "odom";
    message.child_frame_id = values.count(8) == 0 ? "b" : "a";
    message.header.stamp.nsec = values.integer<std::uint32_t>() % 1000000000;
    const geometry_msgs::Transform transform = transformOf(values);
    message.pose.pose.orientation = transform.rotation;
    message.pose.pose.position.x = transform.translation.x;
    message.twist.twist = twistOf(values);
    RootPose pose;
    if (const auto rejection = conversion.convert(message, pose)) {
      requireWord(*rejection);
      continue;
    }
    conversion.takeDoubt();
    estimator.push(pose);
    RootMotion motion;
    if (estimator.read(pose.stamp_ns + values.integer<std::int32_t>(), motion) && !motion.finite())
      failFuzz("a motion of the root that is not finite");
  }
}

void useImu(Values& values) {
  const bool oriented = values.yes();
  ImuConversion conversion(robot(), values.yes() ? "" : "left/", oriented, 0.25);
  RootImu imu(EstimatorSettings(), 100000000, {0, 0, -9.81}, oriented);
  sensor_msgs::Imu message;
  message.header.stamp.sec = values.integer<std::uint32_t>();
  for (std::size_t left = values.count(32); left > 0; --left) {
    const std::size_t link = values.count(robot().links().size());
    message.header.frame_id = link < robot().links().size() ? robot().links()[link].name : "a";
    message.header.stamp.nsec = values.integer<std::uint32_t>() % 1000000000;
    geometry_msgs::Vector3& rate = message.angular_velocity;
    geometry_msgs::Vector3& force = message.linear_acceleration;
    for (double* number : {&rate.x, &rate.y, &rate.z, &force.x, &force.y, &force.z})
      *number = values.number();
    message.linear_acceleration_covariance[0] = values.count(8) == 0 ? -1 : 0;
    message.orientation_covariance[0] = values.count(8) == 0 ? -1 : 0;
    geometry_msgs::Quaternion& turn = message.orientation;
    for (double* number : {&turn.x, &turn.y, &turn.z, &turn.w}) *number = values.number();
    if (values.yes()) {
      const double length = std::hypot(std::hypot(turn.x, turn.y), std::hypot(turn.z, turn.w));
      for (double* number : {&turn.x, &turn.y, &turn.z, &turn.w}) *number /= length;
    }
    ImuSample sample;
    if (const auto rejection = conversion.convert(message, sample)) {
      requireWord(*rejection);
      continue;
    }
    imu.push(sample);
    RootMotion motion;
    RootCovariance covariance;
    const std::int64_t at = sample.stamp_ns + values.integer<std::int32_t>();
    if (imu.read(at, motion, &covariance) && !motion.finite())
      failFuzz("a motion of the root that is not finite");
  }
}

const Mechanism& ball() {
  static const Mechanism ball = readUrdf(
      "<robot name='r'><link name='base'/><link name='body'/><joint name='a' type='floating'>"
      "<parent link='base'/><child link='body'/></joint></robot>");
  return ball;
}

void useFreeJoints(Values& values) {
  const EstimatorSettings settings;
  FreeJoints joints(ball(), settings);
  MotionEstimator estimator(ball(), settings);
  Motion motion(static_cast<Eigen::Index>(ball().coordinates().size()), ball().orientations());
  const std::vector<bool> needed(ball().coordinates().size(), true);
  sensor_msgs::MultiDOFJointState message;
  message.header.stamp.sec = values.integer<std::uint32_t>();
  for (std::size_t left = values.count(32); left > 0; --left) {
    message.joint_names = values.yes() ? std::vector<std::string>{"a"} : values.names();
    message.header.stamp.nsec = values.integer<std::uint32_t>() % 1000000000;
    message.transforms.assign(values.yes() ? message.joint_names.size() : values.count(3),
                              transformOf(values));
    message.twist.assign(values.count(2), twistOf(values));
    JointSample sample;
    if (const auto rejection = joints.take(message, sample)) {
      requireWord(*rejection);
      continue;
    }
    joints.takeDoubt();
    estimator.push(sample.stamp_ns, sample.coordinates, sample.q, sample.qd, sample.count);
    while (estimator.ready()) {
      const std::int64_t at = estimator.evaluate(motion);
      if (!joints.set(at, estimator, needed, motion, nullptr) && !motion.finite())
        failFuzz("a motion that is not finite");
    }
  }
}

void useRootTrajectory(Values& values) {
  RootConversion conversion("odom", "a");
  RootTrajectory trajectory(100000000);
  for (std::size_t left = values.count(4); left > 0; --left) {
    trajectory_msgs::MultiDOFJointTrajectory message;
    message.header.frame_id = "odom";
    message.joint_names = values.yes() ? std::vector<std::string>{"a"} : values.names();
    message.points.resize(values.count(6));
    std::int64_t time = 0;
    for (auto& point : message.points) {
      point.transforms.assign(message.joint_names.size(), transformOf(values));
      point.velocities.assign(values.count(2), twistOf(values));
      point.accelerations.assign(values.count(2), twistOf(values));
      time += values.integer<std::int32_t>();
      point.time_from_start.fromNSec(time);
    }
    std::vector<RootPoint> points;
    const std::int64_t start = values.integer<std::uint32_t>();
    if (const auto rejection = conversion.convert(message, start, points)) {
      requireWord(*rejection);
      continue;
    }
    trajectory.take(points);
    RootMotion motion;
    trajectory.read(start + values.integer<std::int32_t>(), motion);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Values values(data, size);
  acceptOrRefuse([&] {
    (values.yes()   ? useJointStates
     : values.yes() ? useTrajectory
     : values.yes() ? useWrenches
     : values.yes() ? useRootPoses
     : values.yes() ? useImu
     : values.yes() ? useFreeJoints
                    : useRootTrajectory)(values);
  });
  return 0;
}
