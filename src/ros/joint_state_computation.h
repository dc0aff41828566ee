#pragma once

#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MultiDOFJointState.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "ros/active_plan.h"
#include "ros/counters.h"
#include "ros/effort_measurements.h"
#include "ros/free_joints.h"
#include "ros/joint_state_conversion.h"
#include "ros/motion_completer.h"
#include "ros/position_watch.h"
#include "ros/sample_computation.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// Whom JointStateComputation serves: says by which plan to compute, takes the results, and tells
/// of what is amiss.
class JointStateUser {
 public:
  virtual ~JointStateUser() = default;

  /// The plan for the next sample.
  virtual ActivePlan& plan() = 0;
  /// The messages of samples of `plan` hold a new result.
  virtual void publish(const ActivePlan& plan) = 0;

  /// A joint state is not used. @param text names the culprit
  virtual void dropJointState(DropReason reason, const std::string& text) = 0;
  /// A message that tells of joints that turn freely is not used.
  virtual void dropFreeJoints(DropReason reason, const std::string& text) = 0;
  /// A joint state is not used, as it has joints of other robots only.
  virtual void leaveForeign(const std::string& text) = 0;
  /// A sample has no result.
  virtual void dropSample(SampleComputation::Outcome outcome, ActivePlan& plan,
                          std::int64_t stamp_ns) = 0;
  /// Something is doubtful, but used.
  virtual void warn(const std::string& text) = 0;
  /// A joint had a gap; the estimator says which.
  virtual void noteGap() = 0;
  /// Time went back to a stamp, and the estimator restarts.
  virtual void noteRestart(std::int64_t stamp_ns) = 0;
  /// A joint state showed these coordinates.
  virtual void noteSeen(const int* coordinates, int count) = 0;
  /// From now on joint states are taken to give all joints.
  virtual void noteAllGiven() = 0;
};

/// The way of joint states to results, for the node and for recordings: by name to coordinates,
/// by the estimator to an instant, by the closures to all joints, and through the plan. Serves one
/// thread.
class JointStateComputation {
 public:
  /// All but the mechanism are also used by others; everything must outlive this.
  /// @param settings of `estimator`
  JointStateComputation(const Mechanism& mechanism, const EstimatorSettings& settings,
                        MotionEstimator& estimator, MotionCompleter& completer,
                        SampleComputation& samples, Counters& counters, JointStateUser& user);

  /// Hands measured efforts on from now on. @param efforts must outlive this
  void measureEfforts(EffortMeasurements& efforts) { efforts_ = &efforts; }

  /// Takes a joint state, and computes what is due then. Allocates only for what is told.
  /// @returns whether it is used
  bool take(const sensor_msgs::JointState& message);
  /// Takes a message that tells of joints that turn freely, and computes what is due then.
  bool take(const sensor_msgs::MultiDOFJointState& message);

  const FreeJoints& freeJoints() const { return free_joints_; }
  /// Which joint that turns freely was not known when the outcome was kNoTurn.
  std::size_t unknownTurn() const { return unknown_turn_; }

 private:
  using Drop = void (JointStateUser::*)(DropReason reason, const std::string& text);

  bool push(const JointSample& sample, Drop drop);
  void evaluate();
  void setNoise();

  const bool covariances_;
  JointStateConversion conversion_;
  PositionWatch positions_;
  FreeJoints free_joints_;
  std::size_t unknown_turn_ = 0;
  MotionEstimator& estimator_;
  MotionCompleter& completer_;
  SampleComputation& samples_;
  Counters& counters_;
  JointStateUser& user_;
  MotionCovariance covariance_;
  Eigen::VectorXd noise_;  // of single positions
  EffortMeasurements* efforts_ = nullptr;
};

}  // namespace virtual_work_dynamics
