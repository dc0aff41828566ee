#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "loops/follower.h"
#include "ros/rejection.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// Gives the passive joints of a mechanism with closed loops the motion that its closures demand,
/// where joint states and trajectories do not give it. One thread.
///
/// Joint states give the passive joints once each of them has been seen; until then those that are
/// given are ignored. Joint states and trajectories are followed each by themselves.
class LoopCompleter {
 public:
  /// @throws SceneError as ClosedLoopDynamics does.
  LoopCompleter(const Mechanism& mechanism, const Scene& scene);

  const std::vector<bool>& actuated() const { return dynamics_.actuated(); }
  /// The coordinates that joint states have to show.
  const std::vector<bool>& needed() const { return needed_; }
  bool passiveGiven() const { return passive_given_; }
  /// Takes note of the coordinates of a joint state. True when needed() has changed.
  bool saw(const int* coordinates, int count);

  /// The motion of joint states, completed unless they give the passive joints. False when that
  /// cannot be: see problem(). Does not allocate.
  bool complete(Motion& motion);
  /// Why the latest motion could not be completed.
  std::string problem();

  /// Whether the trajectory names all passive joints, or none; in that case it is to be completed.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> check(const TrajectoryMotion& trajectory) const;
  /// Completes the points of a trajectory that gives no passive joint; otherwise only what its
  /// points did not give: velocities of the passive joints, accelerations. Points that cannot be
  /// completed become TrajectoryMotion::open.
  void complete(TrajectoryMotion& trajectory);

 private:
  bool givesPassive(const TrajectoryMotion& trajectory) const;
  void follow(TrajectoryMotion& trajectory);
  void completeDerivatives(TrajectoryMotion& trajectory);

  const std::vector<std::string> joints_;
  std::vector<std::string> closures_;
  const bool static_motion_;
  ClosedLoopDynamics dynamics_;
  LoopFollower joint_states_, trajectories_;
  bool closures_determine_ = false;  // the motion of the passive joints from that of the actuated
  bool passive_given_ = false;
  bool evaluated_ = false;  // a joint state
  std::vector<bool> needed_, seen_;
  Motion motion_;
};

}  // namespace virtual_work_dynamics
