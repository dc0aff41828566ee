#include "replay/replayed_states.h"

#include <ros/message_traits.h>

#include <exception>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "replay/input_bytes.h"
#include "replay/loop_notes.h"
#include "ros/free_joint_conversion.h"
#include "ros/message_copies.h"
#include "ros/message_text.h"
#include "ros/wrench_inputs.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

std::int64_t nanoseconds(ros::Time time) {
  return static_cast<std::int64_t>(time.toNSec());
}

}  // namespace

ReplayedStates::ReplayedStates(const RobotTask& task, const InverseDynamicsParameters& parameters,
                               const MotionSource& source, Publish publish)
    : task_(task),
      source_(source),
      publish_(std::move(publish)),
      wrench_timeout_(parameters.wrench_timeout),
      loop_limits_(parameters.loop_limits),
      loops_(task.everything, task.reactions.size(), parameters.loop_limits),
      estimator_(task.mechanism, task.estimator, task.lengths.size()),
      completer_(task.mechanism, task.scene, task.everything, parameters.loop_limits.tolerance,
                 parameters.drive_start),
      wrenches_(task.mechanism, task.scene, parameters.wrench_timeout),
      roots_(parameters.root, task.mechanism, parameters.frame_prefix, task.scene.gravity,
             task.estimator, counters_),
      samples_(task.everything, task.scene, completer_, wrenches_,
               {counters_, certificates_, loops_}, roots_.course()),
      computation_(task.mechanism, task.estimator, estimator_, completer_, samples_, counters_,
                   *this),
      trajectories_(task.mechanism, task.scene.static_motion, task.following(),
                    parameters.trajectory_sampling, true, estimator_, completer_, samples_, *this),
      wrench_messages_(task.mechanism, parameters, wrenches_, task.wrench_topics.size(),
                       [this](std::size_t i, std::size_t number, const Rejection& rejection) {
                         happenings_[wrench_topics_[i]].drop(rejection.reason, rejection.text,
                                                             number);
                       }),
      scene_inputs_(task.mechanism, task.scene, parameters.frame_prefix, parameters.root,
                    counters_),
      gaps_(task.mechanism, task.scene) {
  if (completer_.needsSome()) estimator_.waitFor(completer_.needed());
  for (const auto& [coordinate, position] : task.rest) estimator_.setRest(coordinate, position);
  loops_.setPassiveGiven(completer_.allGiven());
  computation_.measureEfforts(*task.efforts);
}

// Has messages of a topic handed to a function, with the time of their receipt. Returns the topic.
template <typename Message, typename Function>
std::string ReplayedStates::add(InputTopics& topics, const std::string& name,
                                const std::string& purpose, Function function) {
  const std::string topic = topics.find(name, ros::message_traits::datatype<Message>(),
                                        ros::message_traits::md5sum<Message>(), purpose);
  if (topic.empty()) return topic;
  inputs_.emplace(topic, [this, function, message = Message()](const BagMessage& taken) mutable {
    if (readBytes(taken.bytes, message)) {
      function(message, timeOf(taken.time_ns));
    } else {
      here().drop(DropReason::kInternal, std::string("its bytes are not those of a ") +
                                             ros::message_traits::datatype<Message>());
    }
  });
  return topic;
}

template <typename Message>
void ReplayedStates::addRoot(InputTopics& topics, const std::string& name) {
  using News = RootMessages::News;
  const auto take = [this](const Message& message, ros::Time receipt) {
    if (const auto rejection = roots_.take(message, receipt)) {
      here().drop(rejection->reason, rejection->text);
    }
    const std::string doubt = roots_.takeDoubt();
    if (!doubt.empty()) here().warn(doubt);
    const News news = roots_.takeNews();
    if (news == News::kGap) here().gap(roots_.gapText());
    if (news == News::kRestart) here().restart(roots_.restartText());
  };
  root_topic_ = add<Message>(topics, name, "tells how the root link moves", take);
}

void ReplayedStates::listenToRoot(InputTopics& topics) {
  switch (roots_.settings().source) {
    case RootSource::kNone:
      return;
    case RootSource::kOdometry:
      return addRoot<nav_msgs::Odometry>(topics, "odom");
    case RootSource::kTrajectory:
      return addRoot<trajectory_msgs::MultiDOFJointTrajectory>(topics,
                                                               "multi_dof_joint_trajectory");
    case RootSource::kStates:
      return addRoot<sensor_msgs::MultiDOFJointState>(topics, "multi_dof_joint_states");
    case RootSource::kImu:
      return addRoot<sensor_msgs::Imu>(topics, "imu");
    case RootSource::kTf:
      add<tf2_msgs::TFMessage>(topics, "/tf_static", "",
                               [this](const tf2_msgs::TFMessage& message, ros::Time) {
                                 roots_.takeStatic(message, [this](const Rejection& rejection) {
                                   here().drop(rejection.reason, rejection.text);
                                 });
                               });
      return addRoot<tf2_msgs::TFMessage>(topics, "/tf");
  }
}

void ReplayedStates::listenToWrenches(InputTopics& topics) {
  for (std::size_t i = 0; i < task_.wrench_topics.size(); ++i) {
    wrench_topics_.push_back(add<geometry_msgs::WrenchStamped>(
        topics, "~wrench/" + task_.wrench_topics[i],
        "has the applied wrench " + inQuotes(wrenches_.name(i)) + " that the scene says is live",
        [this, i](const geometry_msgs::WrenchStamped& message, ros::Time receipt) {
          wrench_messages_.take(i, here().messages(), message, nanoseconds(receipt));
        }));
  }
  if (wrench_topics_.empty()) return;
  for (const bool is_static : {false, true}) {
    add<tf2_msgs::TFMessage>(
        topics, is_static ? "/tf_static" : "/tf", "",
        [this, is_static](const tf2_msgs::TFMessage& message, ros::Time receipt) {
          wrench_messages_.takeFrames(message, is_static, nanoseconds(receipt));
        });
  }
}

void ReplayedStates::listen(InputTopics& topics) {
  trajectory_topic_ = add<trajectory_msgs::JointTrajectory>(
      topics, "joint_trajectory", "",
      [this](trajectory_msgs::JointTrajectory& message, ros::Time receipt) {
        translate(message);
        trajectories_.take(message, receipt);
      });
  if (task_.mechanism.orientations() > 0) {
    free_joint_topic_ = add<sensor_msgs::MultiDOFJointState>(
        topics, "multi_dof_joint_states", "tells the orientations of joints that turn freely",
        [this](const sensor_msgs::MultiDOFJointState& message, ros::Time) {
          takeFreeJoints(message);
        });
  }
  listenToRoot(topics);
  listenToWrenches(topics);
  const auto change = [this](const std::optional<Rejection>& rejection) {
    if (rejection) {
      here().drop(rejection->reason, rejection->text);
    } else {
      of_change_ = &here();
    }
  };
  for (const auto& entry : scene_inputs_.payloadTopics()) {
    const int link = entry.second;
    add<geometry_msgs::InertiaStamped>(
        topics, "~" + entry.first, "",
        [this, link, change](const geometry_msgs::InertiaStamped& message, ros::Time) {
          change(scene_inputs_.takePayload(link, message));
        });
  }
  for (const auto& entry : scene_inputs_.contactTopics()) {
    const int closure = entry.second;
    add<std_msgs::Bool>(topics, "~" + entry.first, "",
                        [this, closure, change](const std_msgs::Bool& message, ros::Time receipt) {
                          const bool first = !scene_inputs_.closesSticking();
                          change(scene_inputs_.takeContact(closure, message));
                          if (!first || !scene_inputs_.closesSticking()) return;
                          place_ns_ = nanoseconds(receipt) +
                                      static_cast<std::int64_t>(1e9 * task_.estimator.lag);
                        });
  }
  add<geometry_msgs::Vector3Stamped>(
      topics, "~gravity", "",
      [this, change](const geometry_msgs::Vector3Stamped& message, ros::Time) {
        change(scene_inputs_.takeGravity(0, message));
      });
}

void ReplayedStates::setJointStates(const std::string& topic) {
  joint_state_topic_ = topic;
  of_joint_states_ = &happenings_[topic];
}

void ReplayedStates::setAudience(const Audience& audience) {
  audience_ = audience;
  plan_ = std::make_unique<ActivePlan>(task_.mechanism, scene_inputs_.scene(), task_.outputs,
                                       task_.reactions, audience,
                                       PlanChecks{false, false, loop_limits_.tolerance});
}

// What is to stick does so where it is at an instant that is not before the message: results are
// the estimator's lag behind the newest joint state.
bool ReplayedStates::waitsForPlace() const {
  return !joint_state_topic_.empty() && scene_inputs_.closesSticking() && latest_ns_ < place_ns_;
}

void ReplayedStates::publish(const ActivePlan& plan) {
  latest_ = samples_.motion();
  latest_ns_ = time_ns_;
  publishPoint(plan);
  gaps_.take(*latest_);
  if (gaps_.hand(scene_inputs_)) of_change_ = of_joint_states_;
}

// Compiles a changed scene, when a result is needed.
void ReplayedStates::adaptPlan() {
  const SceneInputs::News news = scene_inputs_.adapt(
      [this](const Scene& scene) {
        plan_ = std::make_unique<ActivePlan>(task_.mechanism, scene, task_.outputs, task_.reactions,
                                             audience_,
                                             PlanChecks{false, false, loop_limits_.tolerance});
      },
      [this](Scene& scene, const std::vector<std::size_t>& contacts) {
        if (latest_) placeContacts(task_.mechanism, *latest_, contacts, scene);
      });
  if (!news.changes.empty()) of_change_->change(news.changes);
  if (!news.refused.empty()) {
    of_change_->drop(DropReason::kNoBody,
                     "what is computed stays as it is, and the change is tried "
                     "again with the next one: " +
                         news.refused);
  }
}

void ReplayedStates::take(const BagMessage& message) {
  const std::string& topic = message.connection->topic;
  const bool is_state = topic == joint_state_topic_;
  const auto [begin, end] = inputs_.equal_range(topic);
  if (!is_state && begin == end) return;
  here_ = is_state ? of_joint_states_ : &happenings_[topic];
  here().next();
  time_ns_ = message.time_ns;
  try {
    wrench_messages_.waitUntil(message.time_ns);
    if (is_state) return takeJointState(message);
    for (auto input = begin; input != end; ++input) input->second(message);
  } catch (const FileError&) {
    throw;  // of the output
  } catch (const std::exception& error) {
    here().drop(DropReason::kInternal, error.what());
  }
}

void ReplayedStates::finish() {
  wrench_messages_.finish();
  if (scene_inputs_.changed()) adaptPlan();
}

void ReplayedStates::takeJointState(const BagMessage& message) {
  if (!readJointState(message.bytes, content_)) {
    dropJointState(DropReason::kInternal, "its bytes are not those of a joint state");
    return;
  }
  message_.header.stamp = timeOf(content_.stamp_ns);
  translate(content_);
  computation_.take(message_);
}

// Poses of the root may come by the same topic.
void ReplayedStates::takeFreeJoints(const sensor_msgs::MultiDOFJointState& message) {
  if (roots_.isOfRoot(message) && !namesFreeJoint(task_.mechanism, message.joint_names)) return;
  computation_.take(message);
}

void ReplayedStates::translate(const JointStateContent& content) {
  message_.position = content.positions;
  message_.velocity = content.velocities;
  message_.effort = content.efforts;
  if (source_.rename.empty() && !source_.degrees) {
    message_.name = content.names;
    return;
  }
  if (given_ != content.names) {
    given_ = content.names;
    message_.name.clear();
    factors_.clear();
    for (const std::string& given : given_) {
      message_.name.push_back(source_.rename(given));
      const int joint = task_.mechanism.jointIndex(message_.name.back());
      const bool turns = joint >= 0 && unitOf(task_.mechanism.joint(joint)) == Unit::kRadian;
      factors_.push_back(source_.degrees && turns ? kDegree : 1);
    }
  }
  for (std::vector<double>* values : {&message_.position, &message_.velocity}) {
    if (values->size() != factors_.size()) continue;  // a message that will be dropped
    for (std::size_t i = 0; i < values->size(); ++i) (*values)[i] *= factors_[i];
  }
}

// Trajectories are planned: their angles are in radians, whatever a driver measures in.
void ReplayedStates::translate(trajectory_msgs::JointTrajectory& message) const {
  if (source_.rename.empty()) return;
  for (std::string& name : message.joint_names) name = source_.rename(name);
}

void ReplayedStates::publishPoint(const ActivePlan& plan) {
  ++results_;
  publish_(plan, false);
}

void ReplayedStates::publishTrajectory(const ActivePlan& plan) {
  publish_(plan, true);
}

void ReplayedStates::dropJointState(DropReason reason, const std::string& text) {
  here().drop(reason, text);
}

void ReplayedStates::dropFreeJoints(DropReason reason, const std::string& text) {
  here().drop(reason, text);
}

void ReplayedStates::dropTrajectory(DropReason reason, const std::string& text) {
  here().drop(reason, text);
}

void ReplayedStates::leaveForeign(const std::string& text) {
  here().leaveForeign(text);
}

void ReplayedStates::dropSample(Outcome outcome, ActivePlan& plan, std::int64_t stamp_ns) {
  const bool open = outcome == Outcome::kOpenLoop || outcome == Outcome::kNoDrive;
  dropPoint(outcome, open ? completer_.problem(plan.dynamics, plan.workspace) : "",
            "stamp " + stampText(stamp_ns));
}

void ReplayedStates::dropPoint(Outcome outcome, const std::string& open_loop,
                               const std::string& where) {
  const std::string at = ", at " + where;
  switch (outcome) {
    case Outcome::kOpenLoop:
      return here().drop(DropReason::kOpenLoop, open_loop + at);
    case Outcome::kNoDrive:
      return here().drop(DropReason::kNoDrive, open_loop + at);
    case Outcome::kNoWrench: {
      const std::size_t i = samples_.unknownWrench();
      return here().drop(
          DropReason::kNoWrench,
          WrenchInputs::problem(wrenches_.history(i), wrench_topics_[i], wrench_timeout_) + at);
    }
    case Outcome::kNoTurn:
      return here().drop(DropReason::kNoTurn,
                         free_joint_topic_ + " does not tell the orientation of " +
                             inQuotes(task_.mechanism.freeJoint(computation_.unknownTurn()).name) +
                             at);
    case Outcome::kNoRoot:
      return here().drop(DropReason::kNoRoot, roots_.problem(root_topic_) + at);
    default:
      return here().drop(DropReason::kOverflow, "not finite at " + where);
  }
}

void ReplayedStates::warn(const std::string& text) {
  here().warn(text);
}

void ReplayedStates::noteGap() {
  const auto joint = static_cast<std::size_t>(estimator_.latestGapCoordinate());
  here().gap(inQuotes(task_.inputs()[joint]) + " had a gap of " +
             numberText(static_cast<double>(estimator_.latestGap()) / 1e9) + " s");
}

void ReplayedStates::noteRestart(std::int64_t stamp_ns) {
  here().restart("time went back to stamp " + stampText(stamp_ns));
}

std::string ReplayedStates::report(const std::string& where) {
  std::string text;
  for (const auto& [topic, happenings] : happenings_) {
    text += happenings.report(where + ": " + topic);
  }
  return text + loopNotes(loops_.take(), task_.everything, task_.mechanism, task_.reactions,
                          loop_limits_, where);
}

std::string ReplayedStates::messages() const {
  std::size_t count = 0;
  std::string others;
  for (const auto& [topic, happenings] : happenings_) {
    if (topic == mainTopic()) {
      count = happenings.messages();
      continue;
    }
    others += (others.empty() ? ", with " : ", ") + std::to_string(happenings.messages()) + " of " +
              inQuotes(topic);
  }
  return std::to_string(count) + (count == 1 ? " message" : " messages") + others;
}

}  // namespace virtual_work_dynamics
