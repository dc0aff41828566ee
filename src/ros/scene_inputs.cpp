#include "ros/scene_inputs.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/fixed_frames.h"
#include "ros/topic_names.h"
#include "scene/closure_types.h"
#include "scene/payloads.h"
#include "scene/touch_rows.h"

namespace virtual_work_dynamics {
namespace {

// Topics of single values, of which the newest one counts.
constexpr std::uint32_t kQueue = 10;

std::string textOf(const Eigen::Vector3d& vector) {
  return "[" + numberText(vector.x()) + ", " + numberText(vector.y()) + ", " +
         numberText(vector.z()) + "]";
}

void addSentence(std::string& sentences, const std::string& sentence) {
  sentences += (sentences.empty() ? "" : "; ") + sentence;
}

bool sameBody(const Payload& one, const Payload& other) {
  return one.mass == other.mass && one.at == other.at && one.inertia == other.inertia;
}

}  // namespace

SceneInputs::SceneInputs(const Mechanism& mechanism, const Scene& scene, std::string frame_prefix,
                         const RootSettings& root, Counters& counters)
    : mechanism_(mechanism),
      frame_prefix_(std::move(frame_prefix)),
      root_(root),
      counters_(counters),
      scene_(scene),
      wanted_(scene) {}

template <typename Message>
ros::Subscriber SceneInputs::listen(
    ros::NodeHandle& node, ros::CallbackQueueInterface& queue, const std::string& topic,
    std::optional<Rejection> (SceneInputs::*take)(int, const Message&), int index) {
  const std::string name = node.resolveName(topic);
  ros::SubscribeOptions options;
  options.init<Message>(topic, kQueue,
                        [this, name, take, index](const boost::shared_ptr<const Message>& message) {
                          counters_.payloads.add();
                          try {
                            if (const auto rejection = (this->*take)(index, *message))
                              drop(name, *rejection);
                          } catch (const std::exception& error) {
                            drop(name, {DropReason::kInternal, printable(error.what())});
                          }
                        });
  options.callback_queue = &queue;
  return node.subscribe(options);
}

void SceneInputs::subscribe(ros::NodeHandle private_node, ros::CallbackQueueInterface& queue) {
  subscribers_.push_back(listen(private_node, queue, "gravity", &SceneInputs::takeGravity, 0));
  const std::map<std::string, int> contacts = contactTopics();
  for (std::size_t i = 0; i < scene_.closures.size(); ++i) {
    const auto closure = static_cast<int>(i);
    if (!hasContactTopic(i)) continue;
    const std::string topic = contactTopic(closure);
    if (contacts.at(topic) != closure) {
      ROS_INFO("%s has no contact topic, as another one's has the same name",
               inQuotes(scene_.closures[i].name).c_str());
      continue;
    }
    subscribers_.push_back(listen(private_node, queue, topic, &SceneInputs::takeContact, closure));
  }
  const std::map<std::string, int> topics = payloadTopics();
  for (std::size_t i = 0; i < mechanism_.links().size(); ++i) {
    const auto link = static_cast<int>(i);
    if (!isDescribed(link)) continue;
    const std::string topic = payloadTopic(link);
    if (topics.at(topic) != link) {
      ROS_INFO("Link %s has no payload topic, as another one's has the same name",
               inQuotes(mechanism_.link(link).name).c_str());
      continue;
    }
    subscribers_.push_back(listen(private_node, queue, topic, &SceneInputs::takePayload, link));
  }
}

// Whether it is a link of the description, rather than one inside of a joint.
bool SceneInputs::isDescribed(int link) const {
  const int joint = mechanism_.link(link).parent_joint;
  return joint < 0 || !mechanism_.isInnerPart(joint);
}

std::string SceneInputs::payloadTopic(int link) const {
  return "payload/" + legalTopicName(mechanism_.link(link).name);
}

std::map<std::string, int> SceneInputs::payloadTopics() const {
  std::map<std::string, int> topics;
  for (std::size_t i = 0; i < mechanism_.links().size(); ++i) {
    const auto link = static_cast<int>(i);
    if (isDescribed(link)) topics.emplace(payloadTopic(link), link);
  }
  return topics;
}

std::string SceneInputs::contactTopic(int closure) const {
  return "contact/" + legalTopicName(scene_.closures[static_cast<std::size_t>(closure)].name);
}

bool SceneInputs::hasContactTopic(std::size_t closure) const {
  const Closure& contact = scene_.closures[closure];
  return traitsOf(contact.type).touches() && !contact.touch.gap;
}

std::map<std::string, int> SceneInputs::contactTopics() const {
  std::map<std::string, int> topics;
  for (std::size_t i = 0; i < scene_.closures.size(); ++i) {
    const auto closure = static_cast<int>(i);
    if (hasContactTopic(i)) topics.emplace(contactTopic(closure), closure);
  }
  return topics;
}

std::optional<Rejection> SceneInputs::takeContact(int closure, const std_msgs::Bool& message) {
  setContact(static_cast<std::size_t>(closure), message.data != 0);
  return std::nullopt;
}

void SceneInputs::setContact(std::size_t index, bool closed,
                             const std::optional<Eigen::Vector3d>& surface) {
  Closure contact = wanted_.closures[index];
  const Eigen::Vector3d at = closed && surface ? *surface : contact.parent.xyz;
  if (contact.touch.closed == closed && contact.parent.xyz == at) return;
  contact.touch.closed = closed;
  Change change;
  change.of = contactTopic(static_cast<int>(index));
  change.text = inQuotes(contact.name) + (closed ? " touches" : " is lifted");
  change.quiet = scene_.closures[index].touch.closed == closed;
  change.apply = [index, closed, at](Scene& scene) {
    scene.closures[index].touch.closed = closed;
    scene.closures[index].parent.xyz = at;
  };
  const std::vector<TouchRow> rows = touchRows(contact);
  if (std::any_of(rows.begin(), rows.end(),
                  [](const TouchRow& row) { return row.adopts_constant; })) {
    change.sticks = index;
  }
  want(std::move(change));
}

std::optional<Rejection> SceneInputs::takePayload(int link,
                                                  const geometry_msgs::InertiaStamped& message) {
  const geometry_msgs::Inertia& given = message.inertia;
  for (const double value : {given.m, given.com.x, given.com.y, given.com.z, given.ixx, given.ixy,
                             given.ixz, given.iyy, given.iyz, given.izz}) {
    if (!std::isfinite(value)) {
      return Rejection{DropReason::kNotFinite, "it has a number that is not finite"};
    }
  }
  FixedFrame frame;
  if (auto rejection =
          findFixedFrame(mechanism_, frame_prefix_, message.header.frame_id, link, frame)) {
    return rejection;
  }
  Payload payload;
  payload.link = mechanism_.link(link).name;
  payload.mass = given.m;
  payload.at = frame.origin + frame.R * Eigen::Vector3d(given.com.x, given.com.y, given.com.z);
  Eigen::Matrix3d inertia;
  inertia << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz,
      given.izz;
  payload.inertia = frame.R * inertia * frame.R.transpose();
  const bool removed = given.m == 0;
  if (!removed) {
    const std::string problem = payloadProblem(payload);
    if (!problem.empty()) return Rejection{DropReason::kNoBody, problem};
  }
  const auto of_link = [&](const Payload& other) { return other.link == payload.link; };
  const auto& payloads = wanted_.payloads;
  const auto there = std::find_if(payloads.begin(), payloads.end(), of_link);
  if (removed ? there == payloads.end() : there != payloads.end() && sameBody(*there, payload)) {
    return std::nullopt;  // as before
  }
  Change change;
  change.of = payloadTopic(link);
  change.text =
      "link " + inQuotes(payload.link) +
      (removed ? " carries nothing"
               : " carries " + numberText(payload.mass) + " kg at " + textOf(payload.at) + " m");
  change.apply = [payload, removed](Scene& scene) {
    auto& all = scene.payloads;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [&](const Payload& other) { return other.link == payload.link; }),
              all.end());
    if (!removed) all.push_back(payload);
  };
  want(std::move(change));
  return std::nullopt;
}

std::optional<Rejection> SceneInputs::takeGravity(int,
                                                  const geometry_msgs::Vector3Stamped& message) {
  Eigen::Vector3d gravity(message.vector.x, message.vector.y, message.vector.z);
  if (!gravity.allFinite()) {
    return Rejection{DropReason::kNotFinite, "its vector is not finite"};
  }
  const std::string& id = message.header.frame_id;
  if (root_.source == RootSource::kImu) {
    return Rejection{DropReason::kUnknownFrame,
                     "the inertial measurement unit feels gravity already"};
  }
  if (scene_.root_moves) {
    if (id != root_.inertial_frame) {
      return Rejection{DropReason::kUnknownFrame, "its frame " + inQuotes(id) +
                                                      " is not the inertial frame " +
                                                      inQuotes(root_.inertial_frame)};
    }
  } else {
    FixedFrame frame;
    if (auto rejection = findFixedFrame(mechanism_, frame_prefix_, id, 0, frame)) return rejection;
    gravity = frame.R * gravity;
  }
  if (gravity == wanted_.gravity) return std::nullopt;
  Change change;
  change.of = "gravity";
  change.text = "gravity is " + textOf(gravity) + " m/s^2";
  change.apply = [gravity](Scene& scene) { scene.gravity = gravity; };
  want(std::move(change));
  return std::nullopt;
}

void SceneInputs::want(Change change) {
  change.apply(wanted_);
  const auto replaced = [&](const Change& other) { return other.of == change.of; };
  changes_.erase(std::remove_if(changes_.begin(), changes_.end(), replaced), changes_.end());
  changes_.push_back(std::move(change));
  changed_ = true;
  again_ = false;
}

void SceneInputs::tryAgain() {
  if (!refused()) return;
  changed_ = again_ = true;
}

bool SceneInputs::closesSticking() const {
  return std::any_of(changes_.begin(), changes_.end(),
                     [](const Change& change) { return change.sticks.has_value(); });
}

void SceneInputs::attempt(const std::vector<Change>& changes, const Compile& compile,
                          const Place& place) {
  Scene scene = scene_;
  std::vector<std::size_t> sticking;
  for (const Change& change : changes) {
    change.apply(scene);
    if (change.sticks) sticking.push_back(*change.sticks);
  }
  if (!sticking.empty()) place(scene, sticking);
  compile(scene);
  scene_ = std::move(scene);
}

SceneInputs::News SceneInputs::adapt(const Compile& compile, const Place& place) {
  changed_ = false;
  News news;
  // Tries changes, which are then no longer wanted. Returns why not.
  const auto refusal = [&](const std::vector<Change>& changes) -> std::string {
    try {
      attempt(changes, compile, place);
    } catch (const std::exception& error) {
      return printable(error.what());
    }
    for (const Change& change : changes) {
      if (!change.quiet) addSentence(news.changes, change.text);
    }
    return "";
  };
  // One foot may be lifted when the other one stands: all at once, then each as often as needed.
  const std::string why_not = refusal(changes_);
  if (why_not.empty()) {
    changes_.clear();
    return news;
  }
  std::vector<std::string> why(changes_.size(), why_not);
  for (bool again = changes_.size() > 1; again;) {
    again = false;
    for (std::size_t i = 0; i < changes_.size();) {
      why[i] = refusal({changes_[i]});
      if (!why[i].empty()) {
        ++i;
        continue;
      }
      changes_.erase(changes_.begin() + static_cast<std::ptrdiff_t>(i));
      why.erase(why.begin() + static_cast<std::ptrdiff_t>(i));
      again = true;
    }
  }
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    if (changes_[i].why_not.empty() || (!again_ && changes_[i].why_not != why[i]))
      addSentence(news.refused, changes_[i].text + " (" + why[i] + ")");
    changes_[i].why_not = why[i];
  }
  return news;
}

void SceneInputs::say(const News& news) {
  // What comes at a rate, as gravity from a sensor, is said now and then.
  if (!news.changes.empty() && change_throttle_.open()) {
    ROS_INFO("The scene has changed: %s", news.changes.c_str());
  }
  if (!news.refused.empty()) {
    ROS_ERROR("A change of the scene is refused, and is tried again with the next one: %s",
              news.refused.c_str());
  }
}

void SceneInputs::drop(const std::string& topic, const Rejection& rejection) {
  counters_.drop(rejection.reason, topic + ": " + rejection.text);
  if (!drop_throttle_.open()) return;
  ROS_WARN("%s: message dropped (%s): %s", topic.c_str(), kDropReasonNames[index(rejection.reason)],
           rejection.text.c_str());
}

}  // namespace virtual_work_dynamics
