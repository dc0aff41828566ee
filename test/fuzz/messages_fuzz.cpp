// Joint states and trajectories from bytes as ROS sends them, up to the core's motions. The first
// byte says which of the two comes.
#include <ros/serialization.h>

#include <cmath>

#include "fuzz_target.h"
#include "ros/joint_state_conversion.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/urdf_reader.h"

using namespace virtual_work_dynamics;

namespace {

const Mechanism& robot() {
  static const Mechanism robot = readUrdfFile(VWD_SOURCE_DIR "/test/fuzz/gripper.urdf");
  return robot;
}

// False for bytes that are no message, which roscpp drops.
template <typename Message>
bool deserialize(const std::uint8_t* data, std::size_t size, Message& message) {
  try {
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(data),
                                       static_cast<std::uint32_t>(size));
    ros::serialization::deserialize(stream, message);
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  } catch (const std::bad_alloc&) {  // a length that memory does not have
    return false;
  } catch (const std::length_error&) {
    return false;
  }
}

void requireWord(const Rejection& rejection) {
  if (rejection.text.empty()) failFuzz("dropped without a word");
}

void useJointState(const std::uint8_t* data, std::size_t size) {
  sensor_msgs::JointState message;
  if (!deserialize(data, size, message)) return;
  JointStateConversion conversion(robot());
  MotionEstimator estimator(robot(), EstimatorSettings());
  Motion motion(static_cast<Eigen::Index>(robot().coordinates().size()));
  for (int round = 0; round < 4; ++round) {
    JointSample sample;
    if (const auto rejection = conversion.convert(message, sample)) return requireWord(*rejection);
    estimator.push(sample.stamp_ns, sample.coordinates, sample.q, sample.qd, sample.count);
    while (estimator.ready()) estimator.evaluate(motion);
    message.header.stamp.nsec += 100000000;
  }
}

void useTrajectory(const std::uint8_t* data, std::size_t size) {
  trajectory_msgs::JointTrajectory message;
  if (!deserialize(data, size, message)) return;
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  acceptOrRefuse([&] { (data[0] % 2 == 0 ? useJointState : useTrajectory)(data + 1, size - 1); });
  return 0;
}
