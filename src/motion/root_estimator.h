#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

#include "motion/root_coordinates.h"
#include "motion/root_course.h"
#include "motion/track_group.h"
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
  using Verdict = TrackGroup::Verdict;
  Verdict push(const RootPose& pose);

  using RootCourse::read;
  bool read(std::int64_t stamp_ns, RootMotion& motion, RootCovariance* covariance) override;
  bool foreseen() const override { return foreseen_; }
  bool empty() const override { return tracks_.empty(); }
  std::int64_t first() const override { return tracks_.first(); }
  std::int64_t last() const override { return tracks_.last(); }

  double interval() const override { return tracks_.interval(); }
  /// What the poses were found to be: the coordinates of the position, then those of the
  /// quaternion.
  StreamQuality quality(std::size_t coordinate) const { return tracks_.quality(coordinate); }
  void getStreams(std::vector<RootStream>& streams) const override;

 private:
  bool readAsItCame(std::int64_t stamp_ns, RootMotion& motion);

  const bool estimate_;
  const std::int64_t timeout_ns_;
  TrackGroup tracks_;
  RootCoordinates newest_;  // its quaternion has the sign that the tracks have
  bool foreseen_ = false;
};

}  // namespace virtual_work_dynamics
