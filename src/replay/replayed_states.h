#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/JointState.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bag/bag_reader.h"
#include "bag/joint_state_bytes.h"
#include "dynamics/live_wrenches.h"
#include "offline/motion_source.h"
#include "replay/happenings.h"
#include "replay/input_topics.h"
#include "replay/replayed_wrenches.h"
#include "ros/active_plan.h"
#include "ros/certificate_record.h"
#include "ros/contact_places.h"
#include "ros/counters.h"
#include "ros/inverse_dynamics_parameters.h"
#include "ros/joint_state_computation.h"
#include "ros/loop_record.h"
#include "ros/motion_completer.h"
#include "ros/robot_task.h"
#include "ros/root_messages.h"
#include "ros/sample_computation.h"
#include "ros/scene_inputs.h"
#include "ros/trajectory_computation.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// Computes recorded messages as the node does, each before the next one, and counts what is amiss
/// with them.
class ReplayedStates : private JointStateUser, private TrajectoryUser {
 public:
  /// Is handed the plan whose messages hold new results, of trajectories or of samples.
  using Publish = std::function<void(const ActivePlan& plan, bool of_trajectories)>;

  /// @param task must outlive it   @param parameters that the task was made of
  /// @param source says what joints and angles are renamed and turned into; must outlive it
  ReplayedStates(const RobotTask& task, const InverseDynamicsParameters& parameters,
                 const MotionSource& source, Publish publish);

  /// Finds the topics of a recording that are read, besides the joint states.
  /// @throws FileError as InputTopics
  void listen(InputTopics& topics);
  /// The topic of trajectories; empty: there is none.
  const std::string& trajectoryTopic() const { return trajectory_topic_; }
  /// Which topic has the joint states; empty: none.
  void setJointStates(const std::string& topic);
  /// Says which outputs are computed. To be called before take().
  void setAudience(const Audience& audience);

  /// Takes a message; of a topic that is not read, nothing happens. One whose processing throws is
  /// dropped.
  /// @throws FileError when results cannot be written.
  void take(const BagMessage& message);
  /// There are no more messages.
  void finish();

  /// Results of samples and points.
  std::size_t results() const { return results_; }
  /// The topic of joint states, or of trajectories where there are no joint states.
  const std::string& mainTopic() const {
    return joint_state_topic_.empty() ? trajectory_topic_ : joint_state_topic_;
  }
  /// How many messages were taken, in words.
  std::string messages() const;
  /// What was amiss, a line each. To be called once. @param where to stand before each
  std::string report(const std::string& where);

 private:
  using Take = std::function<void(const BagMessage&)>;
  using Outcome = SampleComputation::Outcome;

  ActivePlan& plan() override {
    if (scene_inputs_.changed() && !waitsForPlace()) adaptPlan();
    return *plan_;
  }
  void publish(const ActivePlan& plan) override;
  void dropJointState(DropReason reason, const std::string& text) override;
  void dropFreeJoints(DropReason reason, const std::string& text) override;
  void leaveForeign(const std::string& text) override;
  void dropSample(Outcome outcome, ActivePlan& plan, std::int64_t stamp_ns) override;
  void warn(const std::string& text) override;
  void noteGap() override;
  void noteRestart(std::int64_t stamp_ns) override;
  void noteSeen(const int*, int) override {}
  void noteAllGiven() override { loops_.setPassiveGiven(true); }
  void noteTrajectory(const trajectory_msgs::JointTrajectory&, const TrajectoryMotion&) override {}
  void playLater(TrajectoryMotion&&) override {}
  void publishPoint(const ActivePlan& plan) override;
  void publishTrajectory(const ActivePlan& plan) override;
  void dropTrajectory(DropReason reason, const std::string& text) override;
  void dropPoint(Outcome outcome, const std::string& open_loop, const std::string& where) override;

  template <typename Message, typename Function>
  std::string add(InputTopics& topics, const std::string& name, const std::string& purpose,
                  Function function);
  template <typename Message>
  void addRoot(InputTopics& topics, const std::string& name);
  void listenToRoot(InputTopics& topics);
  void listenToWrenches(InputTopics& topics);
  void takeJointState(const BagMessage& message);
  void translate(const JointStateContent& content);
  void translate(trajectory_msgs::JointTrajectory& message) const;
  void takeFreeJoints(const sensor_msgs::MultiDOFJointState& message);
  void adaptPlan();
  bool waitsForPlace() const;

  /// Of the topic of the message that is taken.
  Happenings& here() { return *here_; }

  const RobotTask& task_;
  const MotionSource& source_;
  const Publish publish_;
  const double wrench_timeout_;  // s
  const LoopLimits loop_limits_;
  Counters counters_;
  CertificateRecord certificates_;
  LoopRecord loops_;
  MotionEstimator estimator_;
  MotionCompleter completer_;
  LiveWrenches wrenches_;
  RootMessages roots_;
  SampleComputation samples_;
  JointStateComputation computation_;
  TrajectoryComputation trajectories_;
  ReplayedWrenches wrench_messages_;
  SceneInputs scene_inputs_;
  GapRecord gaps_;
  std::optional<Motion> latest_;  // of joint states
  std::int64_t time_ns_ = 0;      // when the message was received that is taken
  std::int64_t latest_ns_ = 0;    // when the message was received that it was computed at
  std::int64_t place_ns_ = 0;     // from then on results are of instants at which contacts touch
  Audience audience_;
  std::unique_ptr<ActivePlan> plan_;
  std::multimap<std::string, Take> inputs_;  // by topic
  std::string joint_state_topic_, trajectory_topic_, free_joint_topic_, root_topic_;
  std::vector<std::string> wrench_topics_;
  JointStateContent content_;
  sensor_msgs::JointState message_;
  std::vector<std::string> given_;  // names of the latest message, before they became message_'s
  std::vector<double> factors_;     // of its values
  std::size_t results_ = 0;
  std::map<std::string, Happenings> happenings_;  // by topic
  Happenings* here_ = nullptr;
  Happenings* of_joint_states_ = nullptr;
  Happenings* of_change_ = nullptr;  // of the topic that changed the scene the last time
};

}  // namespace virtual_work_dynamics
