#pragma once

#include <trajectory_msgs/JointTrajectory.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ros/rejection.h"
#include "ros/trajectory_samples.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// A trajectory message as a complete motion of all generalized coordinates.
struct TrajectoryMotion {
  MotionTable table;                    ///< a row for each point, times from the first point on
  std::vector<std::int64_t> stamps_ns;  ///< stamps of the points
  std::vector<int> columns;             ///< columns of the message that are coordinates
  std::vector<int> coordinates;         ///< coordinates in the order of `columns`
  std::string completion;               ///< what had to be filled in, and how; empty: nothing
  bool has_velocities = false;          ///< whether the message has them at every point
  std::vector<bool> open;               ///< points whose loops cannot be closed; empty: no point
  std::vector<bool> undriven;           ///< of these: whether a drive has no motion there
  std::string problem;                  ///< why the first such point cannot be closed
  std::vector<bool> rootless;  ///< points whose root's motion is not known; empty: no point
  /// Where the results of samples are wanted, between the points too; empty: at the points.
  std::optional<TrajectorySamples> samples;

  /// Number of results of samples.
  std::size_t results() const { return samples ? samples->count() : stamps_ns.size(); }
  bool isOpen(std::size_t point) const { return point < open.size() && open[point]; }
  bool isUndriven(std::size_t point) const { return point < undriven.size() && undriven[point]; }
  bool isRootless(std::size_t point) const { return point < rootless.size() && rootless[point]; }
};

/// Converts trajectories by joint name into motions by generalized coordinate.
class TrajectoryConversion {
 public:
  /// @param static_motion true: the scene ignores velocities and accelerations, and none are
  ///   completed.
  /// @param passive by coordinate, true where a message may leave it out although no joint state
  ///   has shown it, because closed loops complete it; empty: nowhere.
  /// @param sampling samples/s of the motion between points, Hz; 0: none.
  TrajectoryConversion(const Mechanism& mechanism, bool static_motion, std::vector<bool> passive,
                       double sampling = 0);

  /// Checks and converts a message. Joints that the robot does not have and mimic joints are
  /// ignored; coordinates that the message leaves out rest where the joint states showed them last,
  /// passive ones at zero. Whole turns left out of positions are added (unwrapPositions()).
  /// Velocities and accelerations that the message lacks are zero until complete().
  /// @param start_ns instant from which `time_from_start` counts, ns.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> convert(const trajectory_msgs::JointTrajectory& message,
                                   std::int64_t start_ns, const MotionEstimator& joint_states,
                                   TrajectoryMotion& motion) const;

  /// Fills in velocities and accelerations where not every point of the message has them: by a
  /// Spline through the points, or by the TrajectoryCurve of the samples if there are any.
  /// @param motion the motion that convert() made of the message.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> complete(const trajectory_msgs::JointTrajectory& message,
                                    TrajectoryMotion& motion) const;

 private:
  std::optional<Rejection> resolveNames(const trajectory_msgs::JointTrajectory& message,
                                        TrajectoryMotion& motion) const;
  std::optional<Rejection> sample(const trajectory_msgs::JointTrajectory& message,
                                  TrajectoryMotion& motion) const;
  std::optional<Rejection> holdOthers(const MotionEstimator& joint_states,
                                      TrajectoryMotion& motion) const;

  const Mechanism& mechanism_;
  bool static_motion_;
  std::vector<bool> passive_;
  double sampling_;
  std::unordered_map<std::string, int> coordinate_of_;
};

/// Returns the message with efforts: its columns that are generalized coordinates, in its order.
/// @param efforts a row for each point, a column for each generalized coordinate. A point gets no
///   efforts when one of them is not finite because it does not exist.
trajectory_msgs::JointTrajectory withEfforts(const trajectory_msgs::JointTrajectory& message,
                                             const TrajectoryMotion& motion,
                                             const Eigen::MatrixXd& efforts);

}  // namespace virtual_work_dynamics
