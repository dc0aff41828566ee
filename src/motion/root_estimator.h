#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <vector>

#include "motion/coordinate_track.h"
#include "motion/root_coordinates.h"
#include "motion/root_course.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// A pose of the root link at an instant, with its rates if they are known: vectors of its origin,
/// in inertial axes.
struct RootPose {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_I0, of unit length
  /// m/s and rad/s; NaN: not given.
  Eigen::Vector3d velocity = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d angular_velocity = velocity;
};

/// Estimates the motion of a root link from a stream of its poses: each of the seven
/// RootCoordinates by a CoordinateTrack, as those of joints, at any instant that the poses
/// surround, or that is a little later. The quaternion is continued from pose to pose, so that no
/// attitude is singular, and the motion is found from it exactly, see rootMotionOf().
///
/// The coordinates of a quaternion come to rest one after the other while the root turns on. Were a
/// part of their noise laid to their stamps, which steady motion cannot tell apart, they would be
/// taken for exact just then: noise of stamps counts as one of the poses. Does not allocate after
/// construction.
class RootEstimator : public RootCourse {
 public:
  /// @param settings those of the joints, but noises and bandwidth are found from the poses
  /// @param timeout_ns longest time that an instant may be behind the newest pose
  RootEstimator(const EstimatorSettings& settings, std::int64_t timeout_ns);

  /// What push() did with a pose.
  enum class Verdict {
    kAccepted,
    kReordered,     ///< accepted: it came late, and took its place among the others
    kTooLate,       ///< dropped: it came late, and its place is no longer kept
    kEqualStamp,    ///< dropped: there is a pose of this stamp
    kAfterGap,      ///< accepted, after a gap longer than max_gap
    kRestartedBack  ///< accepted as the first one, as time went far back
  };
  Verdict push(const RootPose& pose);

  bool read(std::int64_t stamp_ns, RootMotion& motion) override;
  bool foreseen() const override { return foreseen_; }
  bool empty() const override { return tracks_.front().empty(); }
  std::int64_t first() const override { return first_; }
  std::int64_t last() const override { return tracks_.front().newest(); }

  /// The latest time from one pose to the next, s; infinite before there are two.
  double interval() const { return interval_; }
  /// What the poses were found to be: the coordinates of the position, then those of the
  /// quaternion.
  StreamQuality quality(std::size_t coordinate) const { return tracks_[coordinate].quality(); }

 private:
  void clear();
  Verdict take(const RootPose& pose, const RootCoordinates& coordinates);
  bool readAsItCame(std::int64_t stamp_ns, RootMotion& motion);

  const bool estimate_;
  const std::int64_t max_gap_ns_, timeout_ns_;
  std::vector<CoordinateTrack> tracks_;
  RootCoordinates newest_;  // its quaternion has the sign that the tracks have
  std::int64_t first_ = 0;
  double interval_ = std::numeric_limits<double>::infinity();
  int behind_ = 0;  // poses in a row that are behind the newest
  bool foreseen_ = false;
};

}  // namespace virtual_work_dynamics
