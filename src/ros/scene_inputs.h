#pragma once

#include <geometry_msgs/InertiaStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <std_msgs/Bool.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ros/counters.h"
#include "ros/rejection.h"
#include "ros/root_settings.h"
#include "ros/throttle.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The scene of a node whose payloads, gravity and contacts change while it runs: by
/// `~payload/<link>`, of every link, `~gravity`, and `~contact/<name>`, which closes what touches a
/// plane or lifts it. It belongs to the thread that compiles plans, whose queue brings the
/// messages, so that the computing thread never waits for a change.
class SceneInputs {
 public:
  /// @param mechanism must outlive it, like counters
  /// @param scene as the node starts with it   @param frame_prefix of every frame_id
  /// @param root which frame is the inertial one, and whether gravity is measured by it
  SceneInputs(const Mechanism& mechanism, const Scene& scene, std::string frame_prefix,
              const RootSettings& root, Counters& counters);

  void subscribe(ros::NodeHandle private_node, ros::CallbackQueueInterface& queue);

  const Scene& scene() const { return scene_; }
  /// Whether the scene is another one than that of the last keep() or takeBack().
  bool changed() const { return !changes_.empty(); }
  /// What has changed since then, as sentences say it.
  std::string changes() const;
  /// The scene was compiled: says what has changed.
  void keep();
  /// The scene was refused: goes back to that of the last keep(), and says why.
  void takeBack(const std::string& why);
  /// As keep() and takeBack(), without a word.
  void keepQuietly();
  void takeBackQuietly();

  // Each take() takes a message, and returns why it is to be dropped, or nothing.

  /// @param link index of the link whose topic it came by
  std::optional<Rejection> takePayload(int link, const geometry_msgs::InertiaStamped& message);
  std::optional<Rejection> takeGravity(int, const geometry_msgs::Vector3Stamped& message);

  /// @param closure index of the contact, wheel or blade whose topic it came by
  std::optional<Rejection> takeContact(int closure, const std_msgs::Bool& message);

  /// The links that have a topic of payloads, by topic below the node's own.
  std::map<std::string, int> payloadTopics() const;
  /// The closures that have a topic, in the same way.
  std::map<std::string, int> contactTopics() const;

 private:
  template <typename Message>
  ros::Subscriber listen(ros::NodeHandle& node, ros::CallbackQueueInterface& queue,
                         const std::string& topic,
                         std::optional<Rejection> (SceneInputs::*take)(int, const Message&),
                         int index);
  bool isDescribed(int link) const;
  std::string payloadTopic(int link) const;
  std::string contactTopic(int closure) const;
  void drop(const std::string& topic, const Rejection& rejection);

  const Mechanism& mechanism_;
  const std::string frame_prefix_;
  const RootSettings root_;
  Counters& counters_;
  Scene scene_, kept_;
  std::vector<std::string> changes_;  // since it was kept, as sentences say them
  Throttle drop_throttle_, change_throttle_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace virtual_work_dynamics
