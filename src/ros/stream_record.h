#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "motion/root_course.h"
#include "ros/free_joints.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// What the joint states of one joint were found to be.
struct JointStream {
  StreamQuality quality;
  bool held = false;           ///< in the latest motion, at its last position
  double age = 0;              ///< s from its latest sample to the latest one of any joint
  bool contradictory = false;  ///< whether its positions jump to and fro
};

/// What the estimator found about the joint states, handed from the receiving thread to the one
/// that reports. The receiving thread never waits.
class StreamRecord {
 public:
  explicit StreamRecord(std::size_t joints) : streams_(joints) {
    root_.reserve(RootCourse::kMostStreams);
  }

  /// Copies from the estimator, from joints that turn freely, for each of their angles, and from
  /// the root's motion unless null, at every kStride-th call, unless the other thread reads just
  /// then.
  void update(const MotionEstimator& estimator, const RootCourse* root,
              const FreeJoints& free_joints);
  /// Whether anything was copied, and what.
  bool read(std::vector<JointStream>& streams, std::vector<RootStream>& root) const;

 private:
  static constexpr unsigned kStride = 64;

  mutable std::mutex mutex_;
  std::vector<JointStream> streams_;
  std::vector<RootStream> root_;
  bool filled_ = false;
  unsigned calls_ = 0;
};

}  // namespace virtual_work_dynamics
