#include "ros/stream_record.h"

namespace virtual_work_dynamics {

void StreamRecord::update(const MotionEstimator& estimator) {
  if (calls_++ % kStride != 0) return;
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const int joint = static_cast<int>(i);
    streams_[i] = {estimator.quality(joint), estimator.held(joint), estimator.age(joint),
                   estimator.contradictory(joint)};
  }
  filled_ = true;
}

bool StreamRecord::read(std::vector<JointStream>& streams) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  streams = streams_;
  return filled_;
}

}  // namespace virtual_work_dynamics
