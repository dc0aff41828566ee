#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/following_motors.h"
#include "dynamics/given_joints.h"
#include "ros/live_drives.h"
#include "ros/rejection.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_fit.h"
#include "virtual_work_dynamics/passive_joints.h"

namespace virtual_work_dynamics {

/// Gives the joints of a mechanism with closed loops that joint states and trajectories do not
/// give, usually the passive ones, the motion that its closures demand. In an open chain every
/// motion is complete. Serves one thread.
///
/// Joint states give what the scene says, and count as giving all joints once each of them has been
/// seen; until then other joints are ignored. Joint states and trajectories are followed
/// independently.
///
/// Actuators of transmissions follow from the joints that they move where all joints are given but
/// they are not: of joint states until all actuators have been seen, too.
///
/// Lengths that are given never follow from joints, whatever joint states show.
///
/// What the scene drives is part of no message, and of none is it used. The time of the drives
/// begins with the first joint state, or the first point of a trajectory that comes before.
class MotionCompleter {
 public:
  /// Largest relative residual of positions of all joints from which loops are closed later on;
  /// encoders are not exact.
  static constexpr double kNearlyClosed = MotionFit::kNearlyClosed;

  /// @param dynamics of the mechanism and the scene, with any request; all three must outlive this
  /// @param tolerance of relative residuals; joint states within it are never far from closed
  /// @param drive_start see LiveDrives
  MotionCompleter(const Mechanism& mechanism, const Scene& scene, const Dynamics& dynamics,
                  double tolerance = kNearlyClosed, double drive_start = 0);

  const Mechanism& mechanism() const { return mechanism_; }
  /// The coordinates, and given lengths behind them, that joint states have to show. Where they
  /// need to show none, it is those of the first joint state, whose stamps then are the instants of
  /// results.
  const std::vector<bool>& needed() const { return needed_; }
  /// Whether needed() is not all coordinates, so that it has to be told to those who wait for them.
  bool needsSome() const { return closed_ || drives_.any(); }
  /// Whether joint states give all joints.
  bool allGiven() const { return all_given_; }
  /// Whether any motion is that of joint states: drives are exact, and so is what follows from
  /// them.
  bool measures() const;
  /// The actuators that follow from the joints once joint states give all of these.
  const std::vector<bool>& following() const { return motors_.coordinates(); }
  /// Takes note of the coordinates of a joint state. Returns whether needed() has changed.
  bool saw(const int* coordinates, int count);
  /// Names of the lengths that joint states give, see givenLengths().
  const std::vector<std::string>& lengths() const { return lengths_; }
  /// Where their values are to be set before a motion of joint states is completed.
  Motion& lengthMotion() { return length_motion_; }
  /// The drives that set what is driven.
  LiveDrives& drives() { return drives_; }

  /// Completes the motion of joint states unless they give all joints, and leaves the workspace at
  /// its position. Returns false when that is not possible; see problem(). The first motion says
  /// where the joint states start, see startedBy(); further ones do not allocate.
  /// @param stamp_ns of the motion, for what is driven
  bool complete(Motion& motion, std::int64_t stamp_ns, const Dynamics& dynamics,
                Dynamics::Workspace& workspace);
  /// Whether motions of joint states are fitted to the closures: those that give all joints.
  bool fits() const { return all_given_ && !drives_.any(); }
  /// Fits a motion of joint states, see MotionFit::fit(). Needs fits(). Does not allocate.
  /// @param fit to the conditions that hold at present
  /// @param covariance loses that of what follows from joints
  const MotionFit::Outcome& fit(MotionFit& fit, Motion& motion, MotionCovariance* covariance,
                                const Eigen::VectorXd& noise) const;
  /// Sets the covariances of what follows from joints in a motion of joint states that is complete.
  /// Does not allocate.
  void complete(MotionCovariance& covariance) const;
  /// Takes note of the results of a motion of joint states. Where all joints are given and leave
  /// the loops open, later completions do not start there, but where loops were closed last. Does
  /// not allocate.
  void took(const Motion& motion, const Results& results);
  /// Says, once, that joint states leave the loops open, and by how much. Allocates then.
  std::optional<std::string> openStates();
  /// Why the latest motion could not be completed.
  std::string problem(const Dynamics& dynamics, Dynamics::Workspace& workspace) const {
    return drives_.failed() ? drives_.problem() : latest_->whyOpen(dynamics, workspace);
  }

  /// Checks that the trajectory names what determines the rest, with joints that the scene says are
  /// given and that rest where they were seen last, or by itself.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> check(const TrajectoryMotion& trajectory);
  /// A joint that turns freely whose orientation trajectories would have to give, which they
  /// cannot: an index of Mechanism::freeJoint(); or nothing.
  std::optional<std::size_t> turnToGive() const;
  /// Completes the points of a trajectory that does not give all joints. In one that gives them it
  /// completes only the velocities and accelerations that the points do not give. Points that
  /// cannot be completed become TrajectoryMotion::open. check() must have passed it.
  void complete(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                Dynamics::Workspace& workspace);

  /// Begins with the samples of a trajectory; one trajectory is sampled at a time.
  void startSamples(const TrajectoryMotion& trajectory);
  /// Gives a sample's other joints the motion that the closures demand, which is not that of a
  /// curve through the points, even where these give it. Returns false when that is not possible;
  /// see problem(). Does not allocate.
  bool completeSample(Motion& motion, std::int64_t stamp_ns, const Dynamics& dynamics,
                      Dynamics::Workspace& workspace);

 private:
  // What a trajectory gives by its names, and what is wrong with that.
  struct Choice {
    Given given;
    std::optional<std::string> problem;
    FollowingMotors motors;  // which the trajectory lacks
  };
  void startBy(const Motion& motion);
  void setDriven();
  Given with(std::vector<bool> coordinates) const;
  void drive(TrajectoryMotion& trajectory);
  std::optional<std::size_t> turnIn(const std::vector<bool>& given) const;
  Choice choose(const std::vector<bool>& named) const;
  std::optional<Choice> chooseJoints(const std::vector<bool>& named) const;
  FollowingMotors noMotors() const;
  bool sawMotors(const int* coordinates, int count);
  const Choice& chosenBy(const TrajectoryMotion& trajectory);
  void setGiven(const Given& given, PassiveJoints& joints) const;
  void follow(TrajectoryMotion& trajectory, const Dynamics& dynamics,
              Dynamics::Workspace& workspace);
  void completeDerivatives(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                           Dynamics::Workspace& workspace);

  const Mechanism& mechanism_;
  const Scene& scene_;
  const Dynamics& dynamics_;
  const bool closed_, static_motion_;
  const bool closures_determine_;  // the passive joints' motion from the actuated ones'
  const double nearly_closed_;
  const Given usual_;  // what motions give unless they give all
  const GivenJoints rule_;
  const Given without_lengths_;
  const std::vector<std::string> lengths_;
  Motion length_motion_;
  Motion driven_;  // numbers of motions of joint states: of drives, then lengths
  LiveDrives drives_;
  FollowingMotors motors_;  // where joint states give all joints
  PassiveJoints joint_states_, trajectories_, samples_;
  const PassiveJoints* latest_ = &joint_states_;  // completed something last
  std::vector<bool> named_;                       // by the trajectory of choice_
  Choice choice_;
  bool samples_give_all_ = false, samples_follow_ = false;
  bool all_given_;
  bool needs_clock_;        // as joint states need not show anything
  bool started_ = false;    // whether a joint state was to be completed
  bool evaluated_ = false;  // whether a joint state was completed
  bool open_ = false, open_told_ = false;
  std::size_t open_closure_ = 0;
  ClosureResidual open_by_, open_relative_;
  std::vector<bool> needed_, seen_;
  Motion motion_;
};

}  // namespace virtual_work_dynamics
