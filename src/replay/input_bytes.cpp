#include "replay/input_bytes.h"

#include <cstddef>

namespace virtual_work_dynamics {
namespace {

// Bytes of numbers.
constexpr std::size_t kReal = 8, kVector = 3 * kReal, kTwist = 2 * kVector, kPose = 7 * kReal;
constexpr std::size_t kCovariance3 = 9 * kReal, kCovariance6 = 36 * kReal;
constexpr std::size_t kDuration = 8;

void takeHeader(ByteCursor& bytes) {
  bytes.word();
  bytes.time();
  bytes.sized();
}

template <typename Take>
void takeEach(ByteCursor& bytes, Take take) {
  const std::uint32_t count = bytes.word();
  for (std::uint32_t i = 0; i < count && bytes.ok(); ++i) take();
}

void takeList(ByteCursor& bytes, std::size_t size) {
  takeEach(bytes, [&] { bytes.bytes(size); });
}

void takeNames(ByteCursor& bytes) {
  takeEach(bytes, [&] { bytes.sized(); });
}

bool areTaken(const ByteCursor& bytes) {
  return bytes.ok() && bytes.empty();
}

// A header and numbers.
bool areStamped(ByteCursor& bytes, std::size_t size) {
  takeHeader(bytes);
  bytes.bytes(size);
  return areTaken(bytes);
}

}  // namespace

bool areBytesOf(ByteCursor bytes, const geometry_msgs::InertiaStamped&) {
  return areStamped(bytes, 10 * kReal);
}

bool areBytesOf(ByteCursor bytes, const geometry_msgs::Vector3Stamped&) {
  return areStamped(bytes, kVector);
}

bool areBytesOf(ByteCursor bytes, const geometry_msgs::WrenchStamped&) {
  return areStamped(bytes, kTwist);
}

bool areBytesOf(ByteCursor bytes, const sensor_msgs::Imu&) {
  return areStamped(bytes, 4 * kReal + 2 * kVector + 3 * kCovariance3);
}

bool areBytesOf(ByteCursor bytes, const nav_msgs::Odometry&) {
  takeHeader(bytes);
  bytes.sized();
  bytes.bytes(kPose + kTwist + 2 * kCovariance6);
  return areTaken(bytes);
}

bool areBytesOf(ByteCursor bytes, const sensor_msgs::MultiDOFJointState&) {
  takeHeader(bytes);
  takeNames(bytes);
  takeList(bytes, kPose);
  takeList(bytes, kTwist);
  takeList(bytes, kTwist);
  return areTaken(bytes);
}

bool areBytesOf(ByteCursor bytes, const std_msgs::Bool&) {
  bytes.bytes(1);
  return areTaken(bytes);
}

bool areBytesOf(ByteCursor bytes, const tf2_msgs::TFMessage&) {
  takeEach(bytes, [&] {
    takeHeader(bytes);
    bytes.sized();
    bytes.bytes(kPose);
  });
  return areTaken(bytes);
}

bool areBytesOf(ByteCursor bytes, const trajectory_msgs::JointTrajectory&) {
  takeHeader(bytes);
  takeNames(bytes);
  takeEach(bytes, [&] {
    for (int list = 0; list < 4; ++list) takeList(bytes, kReal);
    bytes.bytes(kDuration);
  });
  return areTaken(bytes);
}

bool areBytesOf(ByteCursor bytes, const trajectory_msgs::MultiDOFJointTrajectory&) {
  takeHeader(bytes);
  takeNames(bytes);
  takeEach(bytes, [&] {
    takeList(bytes, kPose);
    takeList(bytes, kTwist);
    takeList(bytes, kTwist);
    bytes.bytes(kDuration);
  });
  return areTaken(bytes);
}

}  // namespace virtual_work_dynamics
