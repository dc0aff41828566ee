#pragma once

#include <geometry_msgs/InertiaStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <std_msgs/Bool.h>

#include <cstddef>
#include <functional>
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

  /// The scene that is computed with, of all that was wanted and not refused.
  const Scene& scene() const { return scene_; }
  /// Whether something is wanted that adapt() has not tried yet.
  bool changed() const { return changed_; }
  /// Whether something that sticks where it touches is to be closed.
  bool closesSticking() const;

  /// Compiles a scene; throws where it is refused.
  using Compile = std::function<void(const Scene& scene)>;
  /// Has contacts that are to be closed stick where they are, by their indices among the scene's
  /// closures; throws where that cannot be.
  using Place = std::function<void(Scene& scene, const std::vector<std::size_t>& contacts)>;
  /// What became of what was wanted, as sentences say it.
  struct News {
    std::string changes;
    std::string refused;  ///< what was not refused before for the same reason, with the reason
  };
  /// Compiles the scene that is wanted; where it is refused, with as many of the changes as can be,
  /// of which the last one compiled is scene(). What is refused stays wanted, and is tried again
  /// with all that comes later.
  News adapt(const Compile& compile, const Place& place);
  /// Says the news to the user.
  void say(const News& news);

  // Each take() takes a message, and returns why it is to be dropped, or nothing.

  /// @param link index of the link whose topic it came by
  std::optional<Rejection> takePayload(int link, const geometry_msgs::InertiaStamped& message);
  std::optional<Rejection> takeGravity(int, const geometry_msgs::Vector3Stamped& message);

  /// @param closure index of the contact, wheel or blade whose topic it came by
  std::optional<Rejection> takeContact(int closure, const std_msgs::Bool& message);
  /// Wants a contact closed or lifted.
  /// @param surface a point of the plane that it is closed on; none: the plane stays where it is
  void setContact(std::size_t closure, bool closed,
                  const std::optional<Eigen::Vector3d>& surface = std::nullopt);
  /// Whether something is refused, as it was tried the last time.
  bool refused() const { return !changed_ && !changes_.empty(); }
  /// Has what is refused tried again. Reasons that it had before are not said anew.
  void tryAgain();

  /// The links that have a topic of payloads, by topic below the node's own.
  std::map<std::string, int> payloadTopics() const;
  /// The closures that have a topic, in the same way; not those that open and close by their gap.
  std::map<std::string, int> contactTopics() const;

 private:
  template <typename Message>
  ros::Subscriber listen(ros::NodeHandle& node, ros::CallbackQueueInterface& queue,
                         const std::string& topic,
                         std::optional<Rejection> (SceneInputs::*take)(int, const Message&),
                         int index);
  // A change of the scene that has not been compiled.
  struct Change {
    std::string of;    // what it replaces a change of
    std::string text;  // as a sentence says it
    std::function<void(Scene& scene)> apply;
    std::optional<std::size_t> sticks;  // the closure that it closes
    bool quiet = false;                 // nothing to tell, unless it is refused
    std::string why_not;                // it was refused; empty: not yet
  };

  void want(Change change);
  void attempt(const std::vector<Change>& changes, const Compile& compile, const Place& place);
  bool isDescribed(int link) const;
  std::string payloadTopic(int link) const;
  std::string contactTopic(int closure) const;
  bool hasContactTopic(std::size_t closure) const;
  void drop(const std::string& topic, const Rejection& rejection);

  const Mechanism& mechanism_;
  const std::string frame_prefix_;
  const RootSettings root_;
  Counters& counters_;
  Scene scene_, wanted_;
  std::vector<Change> changes_;  // from the one to the other
  bool changed_ = false;         // since they were tried
  bool again_ = false;           // nothing has changed, and they are tried nevertheless
  Throttle drop_throttle_, change_throttle_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace virtual_work_dynamics
