#include "ros/outputs.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/MultiDOFJointState.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "dynamics/inertial_axes.h"
#include "ros/closure_frames.h"
#include "ros/contact_frames.h"
#include "ros/determinacy_message.h"
#include "ros/deviation_output.h"
#include "ros/effort_output.h"
#include "ros/marker_output.h"
#include "ros/message_copies.h"
#include "ros/residual_output.h"
#include "ros/trajectory_output.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

void addOnce(const Names& added, Names& names) {
  std::unordered_set<std::string> there(names.begin(), names.end());
  for (const std::string& name : added) {
    if (there.insert(name).second) names.push_back(name);
  }
}

std::size_t placeOf(const std::string& name, const Names& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::vector<std::size_t> placesIn(const Names& wanted, const Names& names) {
  std::unordered_map<std::string, std::size_t> place_of;
  for (const std::string& name : names) place_of.emplace(name, place_of.size());
  std::vector<std::size_t> places;
  for (const std::string& name : wanted) places.push_back(place_of.at(name));
  return places;
}

template <typename Message>
ros::AdvertiseOptions advertised(const std::string& topic, std::uint32_t queue) {
  return ros::AdvertiseOptions::create<Message>(topic, queue, {}, {}, ros::VoidConstPtr(), nullptr);
}

// --- ~motion: the positions, velocities and accelerations used

class MotionMessage : public MessageOf<trajectory_msgs::JointTrajectory> {
 public:
  MotionMessage(const Names& names, const std::string& frame) {
    message_.header.frame_id = frame;
    message_.joint_names = names;
    message_.points.resize(1);
    trajectory_msgs::JointTrajectoryPoint& point = message_.points[0];
    for (auto* values : {&point.positions, &point.velocities, &point.accelerations}) {
      values->resize(names.size());
    }
  }

  void fill(const OutputSample& sample) override {
    message_.header.stamp = timeOf(sample.stamp_ns);
    trajectory_msgs::JointTrajectoryPoint& point = message_.points[0];
    for (std::size_t i = 0; i < point.positions.size(); ++i) {
      const auto index = static_cast<Eigen::Index>(i);
      point.positions[i] = sample.motion.q[index];
      point.velocities[i] = sample.motion.qd[index];
      point.accelerations[i] = sample.motion.qdd[index];
    }
  }
};

class MotionOutput : public Output {
 public:
  MotionOutput(Names names, std::string frame)
      : names_(std::move(names)), frame_(std::move(frame)) {}

  std::string topic() const override { return "motion"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return advertised<trajectory_msgs::JointTrajectory>(topic, queue);
  }
  void addTo(Request&) const override {}
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics&, const Scene&) const override {
    return std::make_unique<MotionMessage>(names_, frame_);
  }

 private:
  Names names_;
  std::string frame_;
};

// --- ~reactions: every reaction in root axes (4.3), with the poses of the joint frames;
// --- ~reactions_inertial: the same in inertial axes

class ReactionsMessage : public MessageOf<sensor_msgs::MultiDOFJointState> {
 public:
  ReactionsMessage(const Dynamics& plan, const Names& reactions, const std::string& frame,
                   bool twist, bool inertial, bool placed)
      : names_(reactions),
        places_(placesIn(reactions, plan.request().root_axes)),
        twist_(twist && placed),
        inertial_(inertial),
        placed_(placed) {
    message_.header.frame_id = frame;
    message_.joint_names = names_;
    resize(names_.size());
  }

  void fill(const OutputSample& sample) override {
    message_.header.stamp = timeOf(sample.stamp_ns);
    const auto count = static_cast<std::size_t>(std::count_if(
        places_.begin(), places_.end(), [&](std::size_t i) { return exists(sample.results, i); }));
    const bool as_before = count == names_.size() && message_.joint_names.size() == count;
    if (!as_before) {
      message_.joint_names.clear();
      resize(count);
    }
    std::size_t to = 0;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::size_t from = places_[i];
      if (!exists(sample.results, from)) continue;
      if (!as_before) message_.joint_names.push_back(names_[i]);
      const Pose& pose = sample.results.poses[from];
      const RootMotion& root = sample.motion.root;
      const Wrench& wrench = sample.results.root_axes[from];
      copyWrench(inertial_ ? inInertialAxes(root, wrench) : wrench, message_.wrench[to]);
      if (placed_)
        copyPose(inertial_ ? inInertialFrame(root, pose) : pose, message_.transforms[to]);
      if (twist_) {
        const Twist& twist = sample.results.twists[from];
        copyTwist(inertial_ ? inInertialFrame(root, pose, twist) : twist, message_.twist[to]);
      }
      ++to;
    }
  }

 private:
  static bool exists(const Results& results, std::size_t place) {
    return results.rootAxesExist(place) == kAllComponents;
  }
  void resize(std::size_t count) {
    message_.wrench.resize(count);
    message_.transforms.resize(placed_ ? count : 0);
    message_.twist.resize(twist_ ? count : 0);
  }

  const Names names_;  // all names; the message has those of existing results
  const std::vector<std::size_t> places_;
  const bool twist_, inertial_;
  const bool placed_;  // whether the root's position is known where poses depend on it
};

class ReactionsOutput : public Output {
 public:
  ReactionsOutput(Names reactions, std::string frame, bool twist, bool inertial, bool placed)
      : reactions_(std::move(reactions)),
        frame_(std::move(frame)),
        twist_(twist),
        inertial_(inertial),
        placed_(placed) {}

  std::string topic() const override { return inertial_ ? "reactions_inertial" : "reactions"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return advertised<sensor_msgs::MultiDOFJointState>(topic, queue);
  }
  void addTo(Request& request) const override {
    addOnce(reactions_, request.root_axes);
    request.poses = true;
    request.twists = request.twists || twist_;
  }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
    return std::make_unique<ReactionsMessage>(plan, reactions_, frame_, twist_, inertial_, placed_);
  }

 private:
  Names reactions_;
  std::string frame_;
  bool twist_, inertial_, placed_;
};

// --- ~reaction/<name>: the wrench in the child link's or the closure's own frame

class WrenchMessage : public MessageOf<geometry_msgs::WrenchStamped> {
 public:
  WrenchMessage(const Dynamics& plan, const std::string& reaction, const std::string& frame)
      : place_(placeOf(reaction, plan.request().child_axes)) {
    message_.header.frame_id = frame;
  }

  void fill(const OutputSample& sample) override {
    message_.header.stamp = timeOf(sample.stamp_ns);
    exists_ = sample.results.childAxesExist(place_) == kAllComponents;
    copyWrench(sample.results.child_axes[place_], message_.wrench);
  }

 private:
  const std::size_t place_;
};

class WrenchOutput : public Output {
 public:
  WrenchOutput(std::string reaction, const std::string& name, std::string frame)
      : reaction_(std::move(reaction)), topic_("reaction/" + name), frame_(std::move(frame)) {}

  std::string topic() const override { return topic_; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return advertised<geometry_msgs::WrenchStamped>(topic, queue);
  }
  void addTo(Request& request) const override { addOnce({reaction_}, request.child_axes); }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
    return std::make_unique<WrenchMessage>(plan, reaction_, frame_);
  }

 private:
  std::string reaction_, topic_, frame_;
};

// --- ~determinacy: what rigid-body mechanics determines, latched; published again when it changes

class DeterminacyOutputMessage : public OutputMessage {
 public:
  DeterminacyOutputMessage(const Dynamics& plan, const Names& reactions,
                           std::shared_ptr<DeterminacyMessage> message)
      : root_places_(placesIn(reactions, plan.request().root_axes)),
        child_places_(placesIn(reactions, plan.request().child_axes)),
        message_(std::move(message)) {}

  void fill(const OutputSample& sample) override {
    changed_ = message_->update(sample.stamp_ns, sample.results.loops, root_places_, child_places_);
  }
  void publish(const ros::Publisher& topic) const override {
    if (changed_) topic.publish(message_->message());
  }
  void record(MessageRecorder& recorder) const override {
    if (changed_) recorder.record(message_->message());
  }

 private:
  const std::vector<std::size_t> root_places_, child_places_;
  const std::shared_ptr<DeterminacyMessage> message_;
  bool changed_ = false;
};

class DeterminacyOutput : public Output {
 public:
  DeterminacyOutput(const Mechanism& mechanism, const Dynamics& everything,
                    const OutputSettings& settings)
      : reactions_(settings.reactions),
        message_(std::make_shared<DeterminacyMessage>(assembledDeterminacy(
            mechanism, everything, settings.reactions, settings.condition_warn))) {}

  std::string topic() const override { return "determinacy"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    auto options = advertised<diagnostic_msgs::DiagnosticArray>(topic, queue);
    options.latch = true;
    return options;
  }
  void start(const ros::Publisher& topic) const override { topic.publish(message_->message()); }
  void recordStart(MessageRecorder& recorder) const override {
    recorder.record(message_->message());
  }
  void addTo(Request& request) const override {
    request.efforts = request.determinacy = true;
    addOnce(reactions_, request.child_axes);
    addOnce(reactions_, request.root_axes);
  }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
    return std::make_unique<DeterminacyOutputMessage>(plan, reactions_, message_);
  }

 private:
  Names reactions_;
  // One message for all plans, so that a new plan does not repeat it.
  std::shared_ptr<DeterminacyMessage> message_;
};

}  // namespace

Outputs makeOutputs(const Mechanism& mechanism, const Dynamics& everything,
                    const OutputSettings& settings) {
  const std::string root_frame = settings.frame_prefix + mechanism.links().front().name;
  Outputs outputs;
  outputs.push_back(makeEffortOutput(root_frame, settings.limits));
  outputs.push_back(std::make_unique<MotionOutput>(mechanism.coordinateNames(), root_frame));
  if (settings.deviations) {
    outputs.push_back(makeDeviationOutput(mechanism, root_frame, settings.deviations));
  }
  if (settings.efforts) {
    outputs.push_back(makeResidualOutput(root_frame, settings.efforts,
                                         settings.external_observed ? nullptr : settings.external));
  }
  if (settings.efforts && settings.observer_gain > 0) {
    outputs.push_back(makeExternalEffortOutput(
        mechanism, root_frame, settings.observer_gain, settings.max_gap, settings.efforts,
        settings.external_observed ? settings.external : nullptr));
  }
  if (settings.scene.tolerances.any()) {
    outputs.push_back(makeToleranceOutput(mechanism, root_frame));
  }
  const RootAxes axes = settings.root.axes;
  if (!settings.reactions.empty() && axes != RootAxes::kInertial) {
    outputs.push_back(std::make_unique<ReactionsOutput>(settings.reactions, root_frame,
                                                        settings.twist, false, true));
  }
  if (!settings.reactions.empty() && axes != RootAxes::kRoot) {
    outputs.push_back(std::make_unique<ReactionsOutput>(
        settings.reactions, settings.root.inertial_frame, settings.twist, true,
        settings.root.source != RootSource::kImu));
  }
  outputs.push_back(makeTrajectoryOutput());
  Names frames;
  for (std::size_t i = 0; i < settings.reactions.size(); ++i) {
    const std::string& name = settings.reactions[i];
    frames.push_back(settings.frame_prefix + reactionFrame(mechanism, name));
    outputs.push_back(
        std::make_unique<WrenchOutput>(name, settings.reaction_topics[i], frames.back()));
  }
  if (!settings.reactions.empty()) {
    outputs.push_back(makeMarkerOutput(mechanism, settings, frames, root_frame));
  }
  const Names contacts = movingContacts(settings.scene, settings.reactions);
  if (!contacts.empty()) {
    outputs.push_back(
        makeContactFrames(contacts, root_frame, settings.frame_prefix, settings.marker_rate));
  }
  if (everything.closed()) {
    outputs.push_back(std::make_unique<DeterminacyOutput>(mechanism, everything, settings));
  }
  return outputs;
}

Request requestFor(const Outputs& outputs, const Audience& audience) {
  Request request;
  request.efforts = request.determinacy = false;
  request.child_axes_about_origin = true;  // a WrenchStamped is about the origin of its frame
  for (const std::size_t i : audience) outputs[i]->addTo(request);
  return request;
}

}  // namespace virtual_work_dynamics
