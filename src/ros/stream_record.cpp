#include "ros/stream_record.h"

namespace virtual_work_dynamics {

void StreamRecord::update(const MotionEstimator& estimator, const RootCourse* root,
                          const FreeJoints& free_joints) {
  if (calls_++ % kStride != 0) return;
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const int joint = static_cast<int>(i);
    streams_[i] = {estimator.quality(joint), estimator.held(joint), estimator.age(joint),
                   estimator.contradictory(joint)};
  }
  for (std::size_t i = 0; i < free_joints.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto angle = static_cast<std::size_t>(free_joints.anglesOf(i) + axis);
      streams_[angle].quality = free_joints.quality(i);
    }
  }
  if (root) root->getStreams(root_);
  filled_ = true;
}

bool StreamRecord::read(std::vector<JointStream>& streams, std::vector<RootStream>& root) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  streams = streams_;
  root = root_;
  return filled_;
}

}  // namespace virtual_work_dynamics
