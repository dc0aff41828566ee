#include "ros/inverse_dynamics_node.h"

#include <ros/console.h>
#include <ros/transport_hints.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/message_text.h"
#include "ros/private_name.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// How soon the node's own thread sees that it is to stop, or that a report is due.
constexpr double kManageWait = 0.05;  // s
constexpr double kPlaceWait = 0.5;    // s, for a sample to tell where a contact is
// How often a gap of a joint is logged: those of a slow gripper come with each of its samples.
constexpr std::chrono::seconds kGapPeriod{60};

}  // namespace

using Outcome = SampleComputation::Outcome;

InverseDynamicsNode::InverseDynamicsNode(const InverseDynamicsParameters& parameters)
    : task_(parameters),
      output_queue_(parameters.output_queue),
      at_once_(parameters.trajectory_rate == 0),
      late_threshold_(parameters.late_threshold),
      checks_{parameters.self_check.cross_check_rate > 0, parameters.self_check.certificates,
              parameters.loop_limits.tolerance},
      estimator_(task_.mechanism, task_.estimator, task_.lengths.size()),
      loops_(task_.everything, task_.reactions.size(), parameters.loop_limits),
      completer_(task_.mechanism, task_.scene, task_.everything, parameters.loop_limits.tolerance,
                 parameters.drive_start),
      wrenches_(task_.mechanism, task_.scene, parameters.wrench_timeout),
      root_messages_(parameters.root, task_.mechanism, parameters.frame_prefix, task_.scene.gravity,
                     task_.estimator, counters_),
      root_inputs_(root_messages_, counters_, [this](const auto&... what) { drop(what...); }),
      samples_(task_.everything, task_.scene, completer_, wrenches_,
               {counters_, certificates_, loops_}, root_messages_.course()),
      joint_states_(task_.mechanism, task_.estimator, estimator_, completer_, samples_, counters_,
                    *this),
      trajectories_(task_.mechanism, task_.scene.static_motion, task_.following(),
                    parameters.trajectory_sampling, at_once_, estimator_, completer_, samples_,
                    *this),
      played_(parameters.trajectory_rate),
      streams_(task_.inputs().size()),
      gap_throttles_(task_.inputs().size(), Throttle(kGapPeriod)),
      joint_watch_(task_.inputs(), task_.waitedFor(completer_.needed()), completer_.following()),
      scene_inputs_(task_.mechanism, task_.scene, parameters.frame_prefix, parameters.root,
                    counters_),
      place_(Motion(task_.everything.coordinates(), task_.everything.orientations())),
      gaps_(task_.mechanism, task_.scene),
      plans_(compile(Audience(), task_.scene)),
      cross_check_(checks_.cross_check
                       ? std::make_unique<CrossCheck>(parameters.self_check.cross_check_rate)
                       : nullptr),
      outputs_(ros::NodeHandle("~"), task_.outputs, parameters.output_queue, manage_queue_,
               [this] { audience_changed_ = true; }),
      diagnostics_(counters_, counters_.run_times, joint_watch_,
                   SelfCheckReport(parameters.self_check, cross_check_.get(), certificates_),
                   LoopReport(task_.mechanism, task_.everything, task_.reactions, loops_),
                   StreamReport(streams_, task_.inputs(), task_.units()),
                   DeviationReport(task_.deviations, parameters.deviation_warn),
                   ThresholdReport(task_.external, task_.limits), task_.mechanism.name(),
                   parameters.diagnostic_period),
      sim_time_(ros::Time::isSimTime()),
      wrench_inputs_(task_.mechanism, parameters.frame_prefix, wrenches_, parameters.wrench_timeout,
                     parameters.root, task_.estimator.max_gap, counters_,
                     [this](const auto&... what) { drop(what...); }) {
  task_.log(parameters);
  joint_states_.measureEfforts(*task_.efforts);
  ros::NodeHandle node;
  if (completer_.needsSome()) estimator_.waitFor(completer_.needed());
  for (const auto& [coordinate, position] : task_.rest) estimator_.setRest(coordinate, position);
  loops_.setPassiveGiven(completer_.allGiven());
  if (!task_.closure_frames.transforms.empty()) {
    closure_frames_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
    closure_frames_.publish(task_.closure_frames);
  }
  const auto queue = static_cast<std::uint32_t>(parameters.input_queue);
  const auto hints = ros::TransportHints().tcpNoDelay();
  joint_state_subscriber_ =
      node.subscribe("joint_states", queue, &InverseDynamicsNode::receiveJointState, this, hints);
  trajectory_subscriber_ = node.subscribe("joint_trajectory", queue,
                                          &InverseDynamicsNode::receiveTrajectory, this, hints);
  if (task_.mechanism.orientations() > 0) {
    free_joint_subscriber_ = node.subscribe("multi_dof_joint_states", queue,
                                            &InverseDynamicsNode::receiveFreeJoints, this, hints);
  }
  root_inputs_.subscribe(node, queue);
  wrench_inputs_.subscribe(ros::NodeHandle("~"), task_.wrench_topics, queue);
  scene_inputs_.subscribe(ros::NodeHandle("~"), manage_queue_);
  if (!at_once_) {
    const double period = std::max(1 / parameters.trajectory_rate, TrajectoryQueue::kTick);
    player_ = node.createSteadyTimer(
        ros::WallDuration(period), [this](const ros::SteadyTimerEvent&) { playDue(); }, false,
        false);
  }
  manager_ = std::thread([this] { manage(); });
}

InverseDynamicsNode::~InverseDynamicsNode() {
  stopping_ = true;
  manager_.join();
}

// Drops a message whose processing throws, for example for lack of memory, and keeps the node
// running.
template <typename Work>
void InverseDynamicsNode::guard(const ros::Subscriber& source, Work work) {
  try {
    work();
  } catch (const std::exception& error) {
    drop(source.getTopic(), DropReason::kInternal, printable(error.what()));
  }
}

void InverseDynamicsNode::receiveJointState(
    const ros::MessageEvent<const sensor_msgs::JointState>& event) {
  counters_.joint_states.add();
  receipt_ = event.getReceiptTime();
  guard(joint_state_subscriber_, [&] {
    if (joint_states_.take(*event.getConstMessage())) updateStreams();
  });
}

void InverseDynamicsNode::receiveFreeJoints(
    const ros::MessageEvent<const sensor_msgs::MultiDOFJointState>& event) {
  // Poses of the root may come by the same topic.
  const sensor_msgs::MultiDOFJointState& message = *event.getConstMessage();
  if (root_messages_.isOfRoot(message) && !namesFreeJoint(task_.mechanism, message.joint_names))
    return;
  counters_.free_joints.add();
  receipt_ = event.getReceiptTime();
  guard(free_joint_subscriber_, [&] {
    if (joint_states_.take(message)) updateStreams();
  });
}

void InverseDynamicsNode::updateStreams() {
  streams_.update(estimator_, root_messages_.course(), joint_states_.freeJoints());
}

void InverseDynamicsNode::publish(const ActivePlan& plan) {
  place_.offer(samples_.motion());
  gaps_.take(samples_.motion());
  publishPoint(plan);
  if (!sim_time_ && ros::Time::now() - receipt_ > late_threshold_) counters_.late.add();
}

void InverseDynamicsNode::dropJointState(DropReason reason, const std::string& text) {
  drop(joint_state_subscriber_.getTopic(), reason, text);
}

void InverseDynamicsNode::dropFreeJoints(DropReason reason, const std::string& text) {
  drop(free_joint_subscriber_.getTopic(), reason, text);
}

// Joint states of other robots on the topic are nothing to warn of again and again.
void InverseDynamicsNode::leaveForeign(const std::string& text) {
  if (foreign_reported_) return;
  foreign_reported_ = true;
  ROS_INFO("%s: a message is not used, as %s; others like it are not mentioned",
           joint_state_subscriber_.getTopic().c_str(), text.c_str());
}

void InverseDynamicsNode::dropSample(Outcome outcome, ActivePlan& plan, std::int64_t stamp_ns) {
  dropResult(joint_state_subscriber_, outcome, openLoop(outcome, plan),
             "stamp " + stampText(stamp_ns));
}

void InverseDynamicsNode::warn(const std::string& text) {
  ROS_WARN("%s: %s", joint_state_subscriber_.getTopic().c_str(), text.c_str());
}

void InverseDynamicsNode::noteGap() {
  const auto joint = static_cast<std::size_t>(estimator_.latestGapCoordinate());
  if (!gap_throttles_[joint].open()) return;
  ROS_INFO("%s: %s had a gap of %s s, longer than %s = %s s: it is estimated anew",
           joint_state_subscriber_.getTopic().c_str(), inQuotes(task_.inputs()[joint]).c_str(),
           numberText(static_cast<double>(estimator_.latestGap()) / 1e9).c_str(),
           privateName("estimator/max_gap").c_str(), numberText(task_.estimator.max_gap).c_str());
}

void InverseDynamicsNode::noteRestart(std::int64_t stamp_ns) {
  if (!restart_throttle_.open()) return;
  ROS_INFO("%s: time went back to stamp %s: the estimator restarts",
           joint_state_subscriber_.getTopic().c_str(), stampText(stamp_ns).c_str());
}

void InverseDynamicsNode::noteSeen(const int* coordinates, int count) {
  joint_watch_.saw(coordinates, count);
}

void InverseDynamicsNode::noteAllGiven() {
  joint_watch_.needAll();
  loops_.setPassiveGiven(true);
}

void InverseDynamicsNode::publishPoint(const ActivePlan& plan) {
  outputs_.publishSample(plan);
  counters_.outputs.add();
}

void InverseDynamicsNode::receiveTrajectory(
    const ros::MessageEvent<const trajectory_msgs::JointTrajectory>& event) {
  counters_.trajectories.add();
  guard(trajectory_subscriber_,
        [&] { trajectories_.take(*event.getConstMessage(), event.getReceiptTime()); });
}

std::optional<Rejection> InverseDynamicsNode::whyNotNow() {
  if (played_.waiting() <= static_cast<std::size_t>(output_queue_)) return std::nullopt;
  return Rejection{DropReason::kBacklog, std::to_string(played_.waiting()) +
                                             " points still wait to be played, " + "more than " +
                                             privateName("queue_size/output") + " = " +
                                             std::to_string(output_queue_)};
}

void InverseDynamicsNode::noteTrajectory(const trajectory_msgs::JointTrajectory& message,
                                         const TrajectoryMotion& trajectory) {
  const std::string topic = trajectory_subscriber_.getTopic();
  const std::size_t results = trajectory.results();
  const char* what = trajectory.samples ? "samples" : "points";
  if (!trajectory.completion.empty() && completion_throttle_.open()) {
    ROS_INFO("%s: %zu points, %s", topic.c_str(), message.points.size(),
             trajectory.completion.c_str());
  }
  if (at_once_ && results > static_cast<std::size_t>(output_queue_) && queue_throttle_.open()) {
    ROS_WARN("%s: %zu %s are more than %s = %d; subscribers may lose some", topic.c_str(), results,
             what, privateName("queue_size/output").c_str(), output_queue_);
  }
}

void InverseDynamicsNode::playLater(TrajectoryMotion&& trajectory) {
  played_.add(std::move(trajectory), Clock::now());
  player_.start();
}

void InverseDynamicsNode::publishTrajectory(const ActivePlan& plan) {
  outputs_.publishTrajectory(plan);
}

void InverseDynamicsNode::playDue() {
  guard(trajectory_subscriber_, [this] {
    ActivePlan& plan = plans_.current();
    played_.playDue(Clock::now(), [&](const TrajectoryMotion& trajectory, std::size_t place) {
      trajectories_.play(plan, trajectory, place);
    });
  });
  if (played_.empty()) player_.stop();
}

void InverseDynamicsNode::dropTrajectory(DropReason reason, const std::string& text) {
  drop(trajectory_subscriber_.getTopic(), reason, text);
}

void InverseDynamicsNode::dropPoint(Outcome outcome, const std::string& open_loop,
                                    const std::string& where) {
  dropResult(trajectory_subscriber_, outcome, open_loop, where);
}

// Why the latest motion cannot be completed, if that is the outcome.
std::string InverseDynamicsNode::openLoop(Outcome outcome, ActivePlan& plan) const {
  if (outcome != Outcome::kOpenLoop && outcome != Outcome::kNoDrive) return "";
  return completer_.problem(plan.dynamics, plan.workspace);
}

void InverseDynamicsNode::dropResult(const ros::Subscriber& source, Outcome outcome,
                                     const std::string& open_loop, const std::string& where) {
  const std::string topic = source.getTopic(), at = ", at " + where;
  if (outcome == Outcome::kOpenLoop) {
    drop(topic, DropReason::kOpenLoop, open_loop + at);
  } else if (outcome == Outcome::kNoDrive) {
    drop(topic, DropReason::kNoDrive, open_loop + at);
  } else if (outcome == Outcome::kNoWrench) {
    drop(topic, DropReason::kNoWrench, wrench_inputs_.problem(samples_.unknownWrench()) + at);
  } else if (outcome == Outcome::kNoTurn) {
    drop(topic, DropReason::kNoTurn,
         free_joint_subscriber_.getTopic() + " does not tell the orientation of " +
             inQuotes(task_.mechanism.freeJoint(joint_states_.unknownTurn()).name) + at);
  } else if (outcome == Outcome::kNoRoot) {
    drop(topic, DropReason::kNoRoot, root_inputs_.problem() + at);
  } else {
    drop(topic, DropReason::kOverflow, "not finite at " + where);
  }
}

void InverseDynamicsNode::drop(const std::string& topic, DropReason reason,
                               const std::string& text) {
  counters_.drop(reason, topic + ": " + text);
  if (!drop_throttles_[index(reason)].open()) return;
  const char* what = concernsResult(reason) ? "result" : "message";
  ROS_WARN("%s: %s dropped (%s): %s", topic.c_str(), what, kDropReasonNames[index(reason)],
           text.c_str());
}

void InverseDynamicsNode::manage() {
  while (!stopping_) {
    manage_queue_.callAvailable(ros::WallDuration(kManageWait));
    const Clock::time_point now = Clock::now();
    joint_watch_.setTime(now);
    if (audience_changed_) adaptPlan();
    takeGaps(now);
    const bool news =
        scene_inputs_.changed() ? !waitsForPlace(now) : lacks_place_ && place_.motion();
    if (news) adaptScene();
    plans_.collect();
    watchJoints(now);
    diagnostics_.update(now);
  }
}

std::unique_ptr<ActivePlan> InverseDynamicsNode::compile(const Audience& audience,
                                                         const Scene& scene) const {
  return std::make_unique<ActivePlan>(task_.mechanism, scene, task_.outputs, task_.reactions,
                                      audience, checks_);
}

void InverseDynamicsNode::offerPlan(std::unique_ptr<ActivePlan> plan) {
  diagnostics_.setPlan(describe(*plan), operationsOf(*plan));
  if (cross_check_) cross_check_->watch(plan->cross_check);
  plans_.offer(std::move(plan));
}

void InverseDynamicsNode::adaptPlan() {
  audience_changed_ = false;
  const Audience audience = outputs_.audience();
  diagnostics_.setOutputs(outputs_.names(audience));
  if (audience == audience_) return;
  try {
    offerPlan(compile(audience, scene_inputs_.scene()));
    audience_ = audience;
  } catch (const std::exception& error) {
    ROS_ERROR("the change of subscribers failed, and what is computed stays as it is: %s",
              printable(error.what()).c_str());
  }
}

void InverseDynamicsNode::adaptScene() {
  const Motion* const place = place_.motion();
  const bool lacks_place = !place && counters_.accepted_joint_states.value() > 0;
  std::unique_ptr<ActivePlan> plan;
  scene_inputs_.say(scene_inputs_.adapt(
      [&](const Scene& scene) { plan = compile(audience_, scene); },
      [&](Scene& scene, const std::vector<std::size_t>& contacts) {
        if (lacks_place) {
          throw SceneError("where it is, is not known: no sample of joint states is computed");
        }
        // Of trajectories alone, there is nothing but the assembly.
        if (place) placeContacts(task_.mechanism, *place, contacts, scene);
      }));
  if (plan) offerPlan(std::move(plan));
  if (place) place_.clear();
  closed_since_ = Clock::time_point();
  lacks_place_ = lacks_place && scene_inputs_.closesSticking();
}

// Whether something sticks from now on, of which it is not known yet where: results are of instants
// that lie behind.
bool InverseDynamicsNode::waitsForPlace(Clock::time_point now) {
  if (!scene_inputs_.closesSticking()) return false;
  if (closed_since_ == Clock::time_point()) closed_since_ = now;
  const std::chrono::duration<double> age = now - closed_since_;
  if (age.count() < task_.estimator.lag) {
    place_.clear();
    return true;
  }
  place_.ask();
  return !place_.motion() && age.count() < task_.estimator.lag + kPlaceWait;
}

void InverseDynamicsNode::takeGaps(Clock::time_point now) {
  if (!gaps_.hand(scene_inputs_) || closed_since_ != Clock::time_point()) return;
  place_.clear();
  closed_since_ = now - std::chrono::nanoseconds(ros::Duration(task_.estimator.lag).toNSec());
}

void InverseDynamicsNode::watchJoints(Clock::time_point now) {
  if (joints_reported_) return;
  if (counters_.accepted_joint_states.value() + counters_.foreign.value() == 0) return;
  if (first_joint_state_ == Clock::time_point()) first_joint_state_ = now;
  if (now - first_joint_state_ < JointWatch::kPatience) return;
  joints_reported_ = true;
  for (const std::string& doubt : joint_watch_.doubts()) {
    ROS_WARN("%s: %s", joint_state_subscriber_.getTopic().c_str(), doubt.c_str());
  }
}

}  // namespace virtual_work_dynamics
