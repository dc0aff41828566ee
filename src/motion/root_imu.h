#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "motion/root_course.h"
#include "motion/track_group.h"
#include "motion/turn_estimator.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// What an inertial measurement unit on a link measures at an instant, in the link's axes.
struct ImuSample {
  std::int64_t stamp_ns = 0;
  int link = 0;                                                ///< index; 0 is the root link
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
  /// Acceleration of the unit less gravity, m/s^2: at rest, g upwards.
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< the unit, from the link's origin, m
  /// R_IL of the link; looked at only where the unit is to tell it.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// The motion of a link from an inertial measurement unit on it. Angular velocity and specific
/// force are smoothed by a CoordinateTrack for each component, and the angular acceleration is the
/// derivative of the smoothed velocity. Of the pose nothing needs to be known: gamma - g of the
/// link's origin, its angular velocity and acceleration in its own axes are what (2.5) and (2.7)
/// start from. So the motion that is read has the orientation of the inertial frame unless the unit
/// tells another one, a position of zero, and an acceleration from which gravity has been taken out
/// again by adding `gravity`. Does not allocate after construction.
class RootImu : public RootCourse {
 public:
  /// @param settings those of the joints, but noises and bandwidth are found from the samples
  /// @param timeout_ns longest time that an instant may be behind the newest sample
  /// @param gravity of the scene, m/s^2
  /// @param oriented whether the samples tell the orientation, too
  RootImu(const EstimatorSettings& settings, std::int64_t timeout_ns,
          const Eigen::Vector3d& gravity, bool oriented = false);

  using Verdict = TrackGroup::Verdict;
  Verdict push(const ImuSample& sample);

  using RootCourse::read;
  bool read(std::int64_t stamp_ns, RootMotion& motion, RootCovariance* covariance) override;
  int link() const override { return link_; }
  bool foreseen() const override { return foreseen_; }
  bool empty() const override { return tracks_.empty(); }
  std::int64_t first() const override { return tracks_.first(); }
  std::int64_t last() const override { return tracks_.last(); }
  double interval() const override { return tracks_.interval(); }
  void getStreams(std::vector<RootStream>& streams) const override;

 private:
  const std::int64_t timeout_ns_;
  const Eigen::Vector3d gravity_;
  TrackGroup tracks_;
  std::optional<TurnEstimator> turn_;  // where the samples tell the orientation
  int link_ = 0;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();
  bool foreseen_ = false;
};

}  // namespace virtual_work_dynamics
