#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "dynamics/live_wrenches.h"
#include "ros/certificate_record.h"
#include "ros/contact_places.h"
#include "ros/counters.h"
#include "ros/cross_check.h"
#include "ros/diagnostics.h"
#include "ros/inverse_dynamics_parameters.h"
#include "ros/joint_state_computation.h"
#include "ros/joint_watch.h"
#include "ros/loop_record.h"
#include "ros/motion_completer.h"
#include "ros/output_topics.h"
#include "ros/plan_switch.h"
#include "ros/robot_task.h"
#include "ros/root_inputs.h"
#include "ros/sample_computation.h"
#include "ros/scene_inputs.h"
#include "ros/stream_record.h"
#include "ros/throttle.h"
#include "ros/trajectory_computation.h"
#include "ros/trajectory_queue.h"
#include "ros/wrench_inputs.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// Inverse dynamics between topics: joint states and trajectories in, efforts and reactions out.
///
/// It has two threads, and a third one if Lagrange's equations check results (CrossCheck). The
/// thread that spins the global callback queue receives messages, computes and publishes. The other
/// one is the node's own: it watches who subscribes and what changes of the scene, compiles the
/// plan for them, hands it over by PlanSwitch, and reports diagnostics.
class InverseDynamicsNode : private JointStateUser, private TrajectoryUser {
 public:
  /// Checks everything, then advertises and subscribes; if it throws, it has done neither.
  /// @throws Error, one line naming what is wrong with the robot, the scene or a parameter.
  explicit InverseDynamicsNode(const InverseDynamicsParameters& parameters);
  ~InverseDynamicsNode() override;

 private:
  using Clock = std::chrono::steady_clock;

  // Receiving thread.
  void receiveJointState(const ros::MessageEvent<const sensor_msgs::JointState>& event);
  void receiveFreeJoints(const ros::MessageEvent<const sensor_msgs::MultiDOFJointState>& event);
  void receiveTrajectory(const ros::MessageEvent<const trajectory_msgs::JointTrajectory>& event);
  template <typename Work>
  void guard(const ros::Subscriber& source, Work work);
  ActivePlan& plan() override { return plans_.current(); }
  void publish(const ActivePlan& plan) override;
  void dropJointState(DropReason reason, const std::string& text) override;
  void dropFreeJoints(DropReason reason, const std::string& text) override;
  void leaveForeign(const std::string& text) override;
  void dropSample(SampleComputation::Outcome outcome, ActivePlan& plan,
                  std::int64_t stamp_ns) override;
  void warn(const std::string& text) override;
  void noteGap() override;
  void noteRestart(std::int64_t stamp_ns) override;
  void noteSeen(const int* coordinates, int count) override;
  void noteAllGiven() override;
  std::optional<Rejection> whyNotNow() override;
  void noteTrajectory(const trajectory_msgs::JointTrajectory& message,
                      const TrajectoryMotion& trajectory) override;
  void playLater(TrajectoryMotion&& trajectory) override;
  void publishPoint(const ActivePlan& plan) override;
  void publishTrajectory(const ActivePlan& plan) override;
  void dropTrajectory(DropReason reason, const std::string& text) override;
  void dropPoint(SampleComputation::Outcome outcome, const std::string& open_loop,
                 const std::string& where) override;
  void playDue();
  void updateStreams();
  void dropResult(const ros::Subscriber& source, SampleComputation::Outcome outcome,
                  const std::string& open_loop, const std::string& where);
  std::string openLoop(SampleComputation::Outcome outcome, ActivePlan& plan) const;
  void drop(const std::string& topic, DropReason reason, const std::string& text);

  // The node's own thread.
  void manage();
  void adaptPlan();
  void adaptScene();
  bool waitsForPlace(Clock::time_point now);
  /// Contacts that close by their gap do so where the next sample has them.
  void takeGaps(Clock::time_point now);
  void offerPlan(std::unique_ptr<ActivePlan> plan);
  void watchJoints(Clock::time_point now);
  std::unique_ptr<ActivePlan> compile(const Audience& audience, const Scene& scene) const;

  const RobotTask task_;
  const int output_queue_;
  const bool at_once_;  ///< whether all points of a trajectory are
  const ros::Duration late_threshold_;
  const PlanChecks checks_;

  MotionEstimator estimator_;
  Counters counters_;
  CertificateRecord certificates_;
  LoopRecord loops_;
  MotionCompleter completer_;
  LiveWrenches wrenches_;
  RootMessages root_messages_;
  RootInputs root_inputs_;
  SampleComputation samples_;
  JointStateComputation joint_states_;
  TrajectoryComputation trajectories_;
  ros::Time receipt_;  // of the latest joint state
  TrajectoryQueue played_;
  StreamRecord streams_;
  bool foreign_reported_ = false;
  // By reason, so that a flood of one kind does not hide the others.
  std::array<Throttle, kDropReasonNames.size()> drop_throttles_;
  Throttle restart_throttle_;
  std::vector<Throttle> gap_throttles_;  // by joint
  Throttle completion_throttle_;
  Throttle queue_throttle_;

  JointWatch joint_watch_;
  ros::CallbackQueue manage_queue_;  // of the node's own thread
  SceneInputs scene_inputs_;
  MotionSlot place_;                  // of contacts that are to be closed where they are
  Clock::time_point closed_since_{};  // when the first one came; zero: none did
  bool lacks_place_ = false;          // so that one was refused
  GapRecord gaps_;
  PlanSwitch plans_;
  std::unique_ptr<CrossCheck> cross_check_;  // null when off

  // Constructing the members from here on talks to ROS.
  bool audience_changed_ = true;
  Audience audience_;
  OutputTopics outputs_;
  ros::Publisher closure_frames_;
  Diagnostics diagnostics_;
  Clock::time_point first_joint_state_{};
  bool joints_reported_ = false;
  const bool sim_time_;
  ros::Subscriber joint_state_subscriber_;
  ros::Subscriber trajectory_subscriber_;
  ros::Subscriber free_joint_subscriber_;  // where joints turn freely
  WrenchInputs wrench_inputs_;
  ros::SteadyTimer player_;  // runs while played_ has points
  std::atomic<bool> stopping_{false};
  std::thread manager_;
};

}  // namespace virtual_work_dynamics
