#pragma once

#include <trajectory_msgs/JointTrajectory.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ros/rejection.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// A trajectory message as a complete motion of all generalized coordinates.
struct TrajectoryMotion {
  MotionTable table;                    ///< a row for each point, times from the first point on
  std::vector<std::int64_t> stamps_ns;  ///< of the points
  std::vector<int> columns;             ///< of the message that are generalized coordinates
  std::vector<int> coordinates;         ///< in the order of `columns`
  std::string completion;               ///< what had to be filled in, and how; empty: nothing
  bool has_velocities = false;          ///< the message, at every point
  std::vector<bool> open;               ///< points whose loops cannot be closed; none: all can
  std::string problem;                  ///< of the first of these

  bool isOpen(std::size_t point) const { return point < open.size() && open[point]; }
};

/// Trajectories by joint name to motions by generalized coordinate.
class TrajectoryConversion {
 public:
  /// @param static_motion velocities and accelerations have no part in the scene: none are
  /// completed.
  /// @param passive by coordinate: may be left out all the same, as closed loops complete them;
  /// empty: none.
  TrajectoryConversion(const Mechanism& mechanism, bool static_motion, std::vector<bool> passive);

  /// Checks and converts. Joints that the robot does not have and mimic joints are ignored;
  /// coordinates that the message leaves out rest where the joint states saw them last, passive
  /// ones at zero. Velocities and accelerations that the message lacks are still zero: complete()
  /// has them.
  /// @param start_ns instant that `time_from_start` counts from, ns.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> convert(const trajectory_msgs::JointTrajectory& message,
                                   std::int64_t start_ns, const MotionEstimator& joint_states,
                                   TrajectoryMotion& motion) const;

  /// Where not every point has velocities and accelerations, a Spline through the points gives
  /// them.
  /// @param motion as convert() made it of the message.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> complete(const trajectory_msgs::JointTrajectory& message,
                                    TrajectoryMotion& motion) const;

 private:
  std::optional<Rejection> resolveNames(const trajectory_msgs::JointTrajectory& message,
                                        TrajectoryMotion& motion) const;
  std::optional<Rejection> holdOthers(const MotionEstimator& joint_states,
                                      TrajectoryMotion& motion) const;

  const Mechanism& mechanism_;
  bool static_motion_;
  std::vector<bool> passive_;
  std::unordered_map<std::string, int> coordinate_of_;
};

/// The message with an effort at every point: its columns of generalized coordinates, in its order.
/// @param efforts a row for each point, a column for each generalized coordinate. A point with one
/// that is not finite, as it does not exist, has no efforts.
trajectory_msgs::JointTrajectory withEfforts(const trajectory_msgs::JointTrajectory& message,
                                             const TrajectoryMotion& motion,
                                             const Eigen::MatrixXd& efforts);

}  // namespace virtual_work_dynamics
