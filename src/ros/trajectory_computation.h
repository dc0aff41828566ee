#pragma once

#include <ros/time.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ros/active_plan.h"
#include "ros/motion_completer.h"
#include "ros/sample_computation.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// Whom TrajectoryComputation serves.
class TrajectoryUser {
 public:
  virtual ~TrajectoryUser() = default;

  /// The plan for the next trajectory or played point.
  virtual ActivePlan& plan() = 0;
  /// Why no trajectory is taken at present, or nothing.
  virtual std::optional<Rejection> whyNotNow() { return std::nullopt; }
  /// A trajectory is complete, and its results come next.
  virtual void noteTrajectory(const trajectory_msgs::JointTrajectory& message,
                              const TrajectoryMotion& trajectory) = 0;
  /// Takes a trajectory whose points or samples are to be computed by play(), later.
  virtual void playLater(TrajectoryMotion&& trajectory) = 0;
  /// The messages of samples of `plan` hold the results of a point or a sample.
  virtual void publishPoint(const ActivePlan& plan) = 0;
  /// The messages of trajectories of `plan` hold the results of a trajectory.
  virtual void publishTrajectory(const ActivePlan& plan) = 0;
  /// A trajectory is not used.
  virtual void dropTrajectory(DropReason reason, const std::string& text) = 0;
  /// A point or a sample has no result. @param open_loop why its loops stay open, if they do
  virtual void dropPoint(SampleComputation::Outcome outcome, const std::string& open_loop,
                         const std::string& where) = 0;
};

/// The way of trajectories to results, for the node and for recordings. Serves one thread.
class TrajectoryComputation {
 public:
  /// All but the mechanism are also used by others; everything must outlive this.
  /// @param following by coordinate, whether closures determine it
  /// @param sampling of the motion between points, Hz; 0: none
  /// @param at_once whether all points are computed at once, rather than played
  TrajectoryComputation(const Mechanism& mechanism, bool static_motion, std::vector<bool> following,
                        double sampling, bool at_once, const MotionEstimator& estimator,
                        MotionCompleter& completer, SampleComputation& samples,
                        TrajectoryUser& user);

  /// Takes a trajectory, and computes what is not to be played. @param receipt stands for a stamp
  /// of zero
  void take(const trajectory_msgs::JointTrajectory& message, ros::Time receipt);
  /// Computes one point of a trajectory, or one sample if it has samples.
  void play(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t place);

 private:
  using Outcome = SampleComputation::Outcome;

  void respond(ActivePlan& plan, const trajectory_msgs::JointTrajectory& message);
  void dropPoint(Outcome outcome, const TrajectoryMotion& trajectory, std::size_t point);

  const Mechanism& mechanism_;
  const bool at_once_;
  TrajectoryConversion conversion_;
  const MotionEstimator& estimator_;
  MotionCompleter& completer_;
  SampleComputation& samples_;
  TrajectoryUser& user_;
  TrajectoryMotion trajectory_;
};

}  // namespace virtual_work_dynamics
