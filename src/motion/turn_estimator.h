#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

#include "motion/root_coordinates.h"
#include "motion/track_group.h"
#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// An orientation of a joint that turns freely at an instant, with its rate if it is known.
struct TurnSample {
  std::int64_t stamp_ns = 0;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_PK, of unit length
  /// Of the child, in the axes of the joint's frame on the parent, rad/s; NaN: not given.
  Eigen::Vector3d angular_velocity =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// Estimates how a joint turns from a stream of its orientations, as RootEstimator does for a root:
/// each number of a quaternion, whose sign is continued, by a CoordinateTrack. No attitude is
/// singular. Does not allocate after construction.
class TurnEstimator {
 public:
  /// @param settings those of the joints, but noises and bandwidth are found from the orientations
  explicit TurnEstimator(const EstimatorSettings& settings);

  using Verdict = TrackGroup::Verdict;
  Verdict push(const TurnSample& sample);

  /// Finds the turn at an instant, ns. Returns false, and changes nothing, where it is not known.
  /// @param covariance of the turn, unless null
  bool read(std::int64_t stamp_ns, FreeTurn& turn, TurnCovariance* covariance) const;
  /// The latest orientation up to an instant, at rest: for a joint whose samples have ceased, or
  /// have a gap there. To be called unless empty().
  FreeTurn heldAt(std::int64_t stamp_ns) const;
  bool empty() const { return tracks_.empty(); }
  /// The latest stamp, ns; to be called unless empty().
  std::int64_t last() const { return tracks_.last(); }
  /// Forgets all samples.
  void restart() { tracks_.restart(); }
  /// What the orientations were found to be.
  StreamQuality quality() const;

 private:
  FreeTurn newest() const;

  const bool estimate_;
  const std::int64_t timeout_ns_;
  TrackGroup tracks_;
  RootCoordinates newest_;  // with the sign that the tracks have
};

}  // namespace virtual_work_dynamics
