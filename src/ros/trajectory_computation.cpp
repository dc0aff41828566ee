#include "ros/trajectory_computation.h"

#include <cstdint>
#include <utility>

#include "base/printable.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {

TrajectoryComputation::TrajectoryComputation(const Mechanism& mechanism, bool static_motion,
                                             std::vector<bool> following, double sampling,
                                             bool at_once, const MotionEstimator& estimator,
                                             MotionCompleter& completer, SampleComputation& samples,
                                             TrajectoryUser& user)
    : mechanism_(mechanism),
      at_once_(at_once),
      conversion_(mechanism, static_motion, std::move(following), sampling),
      estimator_(estimator),
      completer_(completer),
      samples_(samples),
      user_(user) {}

void TrajectoryComputation::take(const trajectory_msgs::JointTrajectory& message,
                                 ros::Time receipt) {
  const ros::Time start = message.header.stamp.isZero() ? receipt : message.header.stamp;
  if (start.isZero()) {
    user_.dropTrajectory(DropReason::kNoTime,
                         "its stamp is zero, and /clock has not been received yet");
    return;
  }
  if (const auto turn = completer_.turnToGive()) {
    user_.dropTrajectory(
        DropReason::kOrientation,
        "joint " + inQuotes(mechanism_.freeJoint(*turn).name) +
            " turns freely, and a trajectory of joints does not tell its orientation");
    return;
  }
  auto rejection = conversion_.convert(message, static_cast<std::int64_t>(start.toNSec()),
                                       estimator_, trajectory_);
  if (!rejection) rejection = completer_.check(trajectory_);
  // One plan for the whole trajectory, so that ~joint_trajectory is complete.
  ActivePlan& plan = user_.plan();
  if (!rejection && !plan.wantsPoints()) return;
  if (!rejection) rejection = user_.whyNotNow();
  if (!rejection) rejection = conversion_.complete(message, trajectory_);
  if (rejection) {
    user_.dropTrajectory(rejection->reason, rejection->text);
    return;
  }
  const bool of_points = !trajectory_.samples || plan.wantsTrajectories();
  trajectory_.table.roots.clear();  // of the trajectory before
  if (of_points) completer_.complete(trajectory_, plan.dynamics, plan.workspace);
  if (of_points) samples_.setRoots(trajectory_);
  user_.noteTrajectory(message, trajectory_);
  respond(plan, message);
}

void TrajectoryComputation::respond(ActivePlan& plan,
                                    const trajectory_msgs::JointTrajectory& message) {
  const bool points_at_once = at_once_ && !trajectory_.samples;
  if (points_at_once || plan.wantsTrajectories()) {
    for (ActiveOutput& output : plan.outputs) output.message->begin(message, trajectory_);
    for (std::size_t i = 0; i < trajectory_.stamps_ns.size(); ++i) {
      const Outcome outcome = samples_.computeNext(plan, trajectory_, i, points_at_once);
      if (outcome != Outcome::kDone) {
        dropPoint(outcome, trajectory_, i);
      } else if (points_at_once) {
        user_.publishPoint(plan);
      }
    }
    user_.publishTrajectory(plan);
  }
  if (!plan.wantsSamples()) return;
  if (at_once_ && trajectory_.samples) {
    for (std::size_t i = 0; i < trajectory_.results(); ++i) play(plan, trajectory_, i);
  }
  if (!at_once_) user_.playLater(std::move(trajectory_));
}

void TrajectoryComputation::play(ActivePlan& plan, const TrajectoryMotion& trajectory,
                                 std::size_t place) {
  if (trajectory.samples && place == 0) completer_.startSamples(trajectory);
  if (!plan.wantsSamples()) return;
  const Outcome outcome = trajectory.samples ? samples_.computeSample(plan, trajectory, place)
                                             : samples_.compute(plan, trajectory, place);
  if (outcome == Outcome::kDone) {
    user_.publishPoint(plan);
  } else if (!trajectory.samples) {
    dropPoint(outcome, trajectory, place);
  } else {
    const bool open = outcome == Outcome::kOpenLoop || outcome == Outcome::kNoDrive;
    user_.dropPoint(outcome, open ? completer_.problem(plan.dynamics, plan.workspace) : "",
                    "stamp " + stampText(trajectory.samples->stampNs(place)));
  }
}

void TrajectoryComputation::dropPoint(Outcome outcome, const TrajectoryMotion& trajectory,
                                      std::size_t point) {
  user_.dropPoint(outcome, trajectory.problem, "point " + std::to_string(point + 1));
}

}  // namespace virtual_work_dynamics
