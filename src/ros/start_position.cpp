#include "ros/start_position.h"

#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/subscribe_options.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/given_joints.h"
#include "dynamics/motion_start.h"
#include "ros/given_lengths.h"
#include "ros/joint_state_conversion.h"
#include "ros/live_drives.h"
#include "ros/private_name.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kWait = 0.05;  // s between looks at what has come

// Collects positions from joint states until they close the loops.
class StartFinder {
 public:
  StartFinder(const Mechanism& mechanism, const Scene& scene)
      : mechanism_(mechanism),
        scene_(scene),
        usual_(resolveLoopScene(mechanism, scene).given),
        lengths_(givenLengths(mechanism, scene, usual_)),
        conversion_(mechanism, lengths_),
        driven_(mechanism, scene, withoutLengths(mechanism, scene, usual_), 0),
        seen_(driven_.coordinates()),
        lengths_seen_(lengths_.size(), false),
        numbers_(static_cast<Eigen::Index>(usual_.drivenNumbers())),
        motion_(static_cast<Eigen::Index>(seen_.size())) {}

  void take(const sensor_msgs::JointState& message) {
    JointSample sample;
    if (conversion_.convert(message, sample)) return;
    for (int i = 0; i < sample.count; ++i) {
      const auto place = static_cast<std::size_t>(sample.coordinates[i]);
      if (place >= seen_.size()) {
        const std::size_t length = place - seen_.size();
        lengths_seen_[length] = true;
        numbers_.q[numbers_.q.size() - static_cast<Eigen::Index>(lengths_.size() - length)] =
            sample.q[i];
        continue;
      }
      seen_[place] = true;
      motion_.q[sample.coordinates[i]] = sample.q[i];
    }
    driven_.set(sample.stamp_ns, motion_);
    numbers_.q.head(driven_.numbers().q.size()) = driven_.numbers().q;
    news_ = true;
  }

  // The scene started by what was seen; nothing while that closes no loops.
  std::optional<Scene> find() {
    if (!news_) return std::nullopt;
    news_ = false;
    MotionStart start{usual_, motion_, numbers_};
    start.given.coordinates = seen_;
    if (std::count(lengths_seen_.begin(), lengths_seen_.end(), false) > 0) return std::nullopt;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (usual_.coordinates[i] && !seen_[i]) return std::nullopt;
    }
    if (!GivenJoints::givesAll(start.given)) start.given = usual_;
    try {
      Scene found = startedBy(mechanism_, scene_, start);
      found.given = scene_.given;
      return found;
    } catch (const AssemblyError& error) {
      if (!told_)
        ROS_WARN("the joint states do not tell either: %s", printable(error.what()).c_str());
      told_ = true;
      return std::nullopt;
    }
  }

 private:
  const Mechanism& mechanism_;
  const Scene& scene_;
  const Given usual_;
  const std::vector<std::string> lengths_;
  JointStateConversion conversion_;
  LiveDrives driven_;
  std::vector<bool> seen_, lengths_seen_;
  Motion numbers_;  // of drives, then lengths
  Motion motion_;
  bool news_ = false, told_ = false;
};

}  // namespace

Scene assembledScene(const Mechanism& mechanism, const Scene& scene, double patience) {
  using Clock = std::chrono::steady_clock;
  if (patience == 0 || !needsClosedLoops(scene)) return scene;
  try {
    const Dynamics dynamics(mechanism, scene, Request());
    return scene;
  } catch (const AssemblyError& error) {
    ROS_WARN("%s; waiting up to %s = %s s for joint states that say where the loops start",
             printable(error.what()).c_str(), privateName("start_patience").c_str(),
             numberText(patience).c_str());
    StartFinder finder(mechanism, scene);
    ros::CallbackQueue queue;
    ros::NodeHandle node;
    node.setCallbackQueue(&queue);
    const ros::Subscriber subscriber = node.subscribe<sensor_msgs::JointState>(
        "joint_states", 10,
        [&](const sensor_msgs::JointStateConstPtr& message) { finder.take(*message); });
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                     std::chrono::duration<double>(patience));
    while (ros::ok() && Clock::now() < end) {
      queue.callAvailable(ros::WallDuration(kWait));
      if (auto found = finder.find()) return *found;
    }
    throw;
  }
}

}  // namespace virtual_work_dynamics
