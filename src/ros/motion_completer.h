#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/given_joints.h"
#include "ros/rejection.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/passive_joints.h"

namespace virtual_work_dynamics {

/// Gives the passive joints of a mechanism with closed loops the motion that its closures demand,
/// where joint states and trajectories do not give it. In an open chain every motion is complete.
/// Serves one thread.
///
/// Joint states count as giving the passive joints once each of them has been seen; until then
/// those that are given are ignored. Joint states and trajectories are followed independently.
class MotionCompleter {
 public:
  /// @param dynamics of the mechanism and the scene, with any request
  MotionCompleter(const Mechanism& mechanism, const Dynamics& dynamics, bool static_motion);

  /// The coordinates that joint states have to show.
  const std::vector<bool>& needed() const { return needed_; }
  /// Whether joint states give the passive joints.
  bool passiveGiven() const { return passive_given_; }
  /// Takes note of the coordinates of a joint state. Returns whether needed() has changed.
  bool saw(const int* coordinates, int count);

  /// Completes the motion of joint states unless they give the passive joints, and leaves the
  /// workspace at its position. Returns false when that is not possible; see problem(). Does not
  /// allocate.
  bool complete(Motion& motion, const Dynamics& dynamics, Dynamics::Workspace& workspace);
  /// Why the latest motion could not be completed.
  std::string problem(const Dynamics& dynamics, Dynamics::Workspace& workspace) const {
    return dynamics.whyOpen(motion_, workspace);
  }

  /// Checks that the trajectory names all passive joints, or none, so that it can be completed.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> check(const TrajectoryMotion& trajectory) const;
  /// Completes the points of a trajectory that gives no passive joint. In one that gives them it
  /// completes only the velocities and accelerations that the points do not give. Points that
  /// cannot be completed become TrajectoryMotion::open.
  void complete(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                Dynamics::Workspace& workspace);

  /// Begins with the samples of a trajectory; one trajectory is sampled at a time.
  void startSamples(const TrajectoryMotion& trajectory);
  /// Gives a sample's passive joints the motion that the closures demand, which is not that of a
  /// curve through the points, even where these give it. Returns false when that is not possible;
  /// see problem(). Does not allocate.
  bool completeSample(Motion& motion, const Dynamics& dynamics, Dynamics::Workspace& workspace);

 private:
  std::vector<bool> given(const TrajectoryMotion& trajectory) const;
  void follow(TrajectoryMotion& trajectory, const Dynamics& dynamics,
              Dynamics::Workspace& workspace);
  void completeDerivatives(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                           Dynamics::Workspace& workspace);

  const bool closed_, static_motion_;
  const bool closures_determine_;  // the passive joints' motion from the actuated ones'
  const std::vector<bool> actuated_;
  const GivenJoints rule_;
  PassiveJoints joint_states_, trajectories_, samples_;
  bool samples_give_passive_ = false;
  bool passive_given_;
  bool evaluated_ = false;  // whether a joint state was completed
  std::vector<bool> needed_, seen_;
  Motion motion_;
};

}  // namespace virtual_work_dynamics
