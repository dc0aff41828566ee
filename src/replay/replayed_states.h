#pragma once

#include <sensor_msgs/JointState.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bag/joint_state_bytes.h"
#include "dynamics/live_wrenches.h"
#include "offline/motion_source.h"
#include "ros/active_plan.h"
#include "ros/certificate_record.h"
#include "ros/counters.h"
#include "ros/joint_state_computation.h"
#include "ros/loop_record.h"
#include "ros/motion_completer.h"
#include "ros/robot_task.h"
#include "ros/sample_computation.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// Computes recorded joint states as the node does, and counts what is amiss with them.
class ReplayedStates : private JointStateUser {
 public:
  /// @param task must outlive it
  /// @param source says what joints and angles are renamed and turned into; must outlive it
  /// @param audience of the outputs that are computed
  /// @param publish is handed the plan whose messages hold a new result
  ReplayedStates(const RobotTask& task, const MotionSource& source, const LoopLimits& limits,
                 const Audience& audience, std::function<void(const ActivePlan&)> publish);

  /// Takes a joint state. @param number of the message, from 1
  void take(const JointStateContent& content, std::size_t number);
  /// Takes note of a message that is not one.
  void refuse(std::size_t number, const std::string& why);

  std::size_t results() const { return results_; }
  /// What was amiss, a line each with its number of times and the first one: warnings, then notes.
  /// @param where to stand before each
  std::string report(const std::string& where) const;

 private:
  /// Something that happens several times.
  struct Happening {
    std::size_t count = 0;
    std::string first;
  };

  ActivePlan& plan() override { return plan_; }
  void publish(const ActivePlan& plan) override;
  void dropJointState(DropReason reason, const std::string& text) override;
  void dropFreeJoints(DropReason reason, const std::string& text) override {
    dropJointState(reason, text);
  }
  void leaveForeign(const std::string& text) override;
  void dropSample(SampleComputation::Outcome outcome, ActivePlan& plan,
                  std::int64_t stamp_ns) override;
  void warn(const std::string& text) override;
  void noteGap() override;
  void noteRestart(std::int64_t stamp_ns) override;
  void noteSeen(const int*, int) override {}
  void noteAllGiven() override { loops_.setPassiveGiven(true); }
  void translate(const JointStateContent& content);
  void happen(Happening& happening, const std::string& text);

  const RobotTask& task_;
  const MotionSource& source_;
  const std::function<void(const ActivePlan&)> publish_;
  Counters counters_;
  CertificateRecord certificates_;
  LoopRecord loops_;
  MotionEstimator estimator_;
  MotionCompleter completer_;
  LiveWrenches wrenches_;
  SampleComputation samples_;
  ActivePlan plan_;
  JointStateComputation computation_;
  sensor_msgs::JointState message_;
  std::vector<std::string> given_;  // names of the latest message, before they became message_'s
  std::vector<double> factors_;     // of its values
  std::size_t number_ = 0;          // of the message
  std::size_t results_ = 0;
  std::map<DropReason, Happening> dropped_;
  std::map<std::string, Happening> doubts_;  // by text
  Happening foreign_, gaps_, restarts_;
};

}  // namespace virtual_work_dynamics
