#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "motion/turn_estimator.h"
#include "ros/free_joint_conversion.h"
#include "ros/joint_state_conversion.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// The joints of a robot that turn freely, as messages tell of them. Their orientations are
/// estimated here; for the estimator of all other coordinates their angles are positions of zero,
/// so that instants, gaps and what is held are those of the messages. Serves one thread.
class FreeJoints {
 public:
  /// @param mechanism must outlive it
  FreeJoints(const Mechanism& mechanism, const EstimatorSettings& settings);

  /// Takes a message. Allocates only for a rejection.
  /// @param sample receives what the estimator of the other coordinates is to take; its pointers
  ///   are valid until the next call
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> take(const sensor_msgs::MultiDOFJointState& message,
                                JointSample& sample);
  /// Time went back to a stamp, which may be of the latest message: forgets the orientations of
  /// joints that have later ones.
  void restart(std::int64_t stamp_ns);
  std::string takeDoubt() { return conversion_.takeDoubt(); }

  /// Sets orientations and angles of a motion at an instant. Of a joint that the estimator holds it
  /// is the latest orientation up to the instant, at rest. Does not allocate.
  /// @param needed by coordinate; joints whose angles are not stay as they are
  /// @param motion has orientations   @param covariance of it, with turns, unless null
  /// @returns the first joint, an index of orientations, whose turn is not known; or nothing
  std::optional<std::size_t> set(std::int64_t stamp_ns, const MotionEstimator& estimator,
                                 const std::vector<bool>& needed, Motion& motion,
                                 MotionCovariance* covariance) const;

  std::size_t size() const { return turns_.size(); }
  /// The first of the three angles of a joint, a coordinate.
  int anglesOf(std::size_t i) const { return mechanism_.anglesOf(i); }
  StreamQuality quality(std::size_t i) const { return turns_[i].quality(); }

 private:
  const Mechanism& mechanism_;
  FreeJointConversion conversion_;
  std::vector<TurnEstimator> turns_;      // by orientation
  std::vector<std::vector<int>> slides_;  // by orientation: the coordinates x, y, z, or none
  std::vector<FreeJointSample> samples_;
  std::vector<int> coordinates_;
  std::vector<double> q_, qd_;
};

}  // namespace virtual_work_dynamics
