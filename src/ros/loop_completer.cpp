#include "ros/loop_completer.h"

#include <algorithm>

#include "base/number_text.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {
namespace {

// Relative; misfits below it are rounding errors, and what hinders is the position.
constexpr double kClosed = 1e-9;

void takeRow(const MotionTable& table, Eigen::Index row, Motion& motion) {
  motion.q = table.positions.row(row);
  motion.qd = table.velocities.row(row);
  motion.qdd = table.accelerations.row(row);
}

}  // namespace

LoopCompleter::LoopCompleter(const Mechanism& mechanism, const Scene& scene)
    : joints_(mechanism.coordinateNames()),
      static_motion_(scene.static_motion),
      dynamics_(mechanism, scene, Request{false, {}, {}, false, false}),
      joint_states_(mechanism, dynamics_),
      trajectories_(mechanism, dynamics_),
      needed_(dynamics_.actuated()),
      seen_(joints_.size(), false),
      motion_(dynamics_.coordinates()) {
  for (const Closure& closure : scene.closures) closures_.push_back(closure.name);
  closures_determine_ = !closures_.empty() && dynamics_.actuatedClosures().empty();
  const bool none_passive = std::count(needed_.begin(), needed_.end(), false) == 0;
  passive_given_ = none_passive || !closures_determine_;
  if (passive_given_) needed_.assign(needed_.size(), true);
}

bool LoopCompleter::saw(const int* coordinates, int count) {
  if (passive_given_) return false;
  for (int i = 0; i < count; ++i) seen_[static_cast<std::size_t>(coordinates[i])] = true;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (!seen_[i] && !needed_[i]) return false;
  }
  passive_given_ = true;
  needed_.assign(needed_.size(), true);
  return true;
}

bool LoopCompleter::complete(Motion& motion) {
  evaluated_ = true;
  if (static_motion_) {
    motion.qd.setZero();
    motion.qdd.setZero();
  }
  if (passive_given_) {
    joint_states_.moveTo(motion.q);
    return true;
  }
  if (joint_states_.complete(motion, dynamics_)) return true;
  motion_ = motion;
  return false;
}

std::string LoopCompleter::problem() {
  dynamics_.compute(motion_);
  const std::vector<ClosureResidual>& relative = dynamics_.relativeResiduals();
  const auto worst = std::max_element(
      relative.begin(), relative.end(),
      [](const auto& one, const auto& other) { return one.position < other.position; });
  if (worst->position <= kClosed) {
    return "the closures do not determine how the passive joints move: a singular position; all "
           "joints would have to be given";
  }
  const auto closure = static_cast<std::size_t>(worst - relative.begin());
  return "the loops cannot be closed: closure '" + closures_[closure] + "' stays open by " +
         numberText(dynamics_.residuals()[closure].position) + " m or rad";
}

bool LoopCompleter::givesPassive(const TrajectoryMotion& trajectory) const {
  return std::any_of(trajectory.coordinates.begin(), trajectory.coordinates.end(),
                     [&](int i) { return !dynamics_.actuated()[static_cast<std::size_t>(i)]; });
}

std::optional<Rejection> LoopCompleter::check(const TrajectoryMotion& trajectory) const {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto& given = trajectory.coordinates;
    const bool is_given = std::count(given.begin(), given.end(), static_cast<int>(i)) > 0;
    if (!is_given && !dynamics_.actuated()[i]) missing.push_back(joints_[i]);
  }
  if (missing.empty()) return std::nullopt;
  if (!closures_determine_) {
    return Rejection{DropReason::kPassiveJoints,
                     "it leaves out " + shortList(missing) +
                         ": where a closure is actuated, all joints must be given"};
  }
  if (!givesPassive(trajectory)) return std::nullopt;
  return Rejection{DropReason::kPassiveJoints, "it names passive joints, but not " +
                                                   shortList(missing) +
                                                   ": name all joints or the actuated ones only"};
}

void LoopCompleter::complete(TrajectoryMotion& trajectory) {
  trajectory.open.assign(trajectory.stamps_ns.size(), false);
  const bool all_given = givesPassive(trajectory);
  if (!all_given && closures_determine_) {
    follow(trajectory);
  } else if (closures_determine_ && !static_motion_ && !trajectory.completion.empty()) {
    completeDerivatives(trajectory);
  } else {
    return;
  }
  if (!trajectory.completion.empty()) trajectory.completion += "; passive joints by the closures";
}

void LoopCompleter::follow(TrajectoryMotion& trajectory) {
  MotionTable& table = trajectory.table;
  if (evaluated_) trajectories_.moveTo(joint_states_.position());
  for (std::size_t i = 0; i < trajectory.open.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    takeRow(table, row, motion_);
    if (static_motion_) {
      motion_.qd.setZero();
      motion_.qdd.setZero();
    }
    trajectory.open[i] = !trajectories_.complete(motion_, dynamics_);
    if (trajectory.open[i] && trajectory.problem.empty()) trajectory.problem = problem();
    table.positions.row(row) = motion_.q;
    table.velocities.row(row) = motion_.qd;
    table.accelerations.row(row) = motion_.qdd;
  }
}

// Positions stay as they are given. Where these are far from closing the loops, so do the others,
// and the residuals show it.
void LoopCompleter::completeDerivatives(TrajectoryMotion& trajectory) {
  MotionTable& table = trajectory.table;
  for (Eigen::Index row = 0; row < table.positions.rows(); ++row) {
    takeRow(table, row, motion_);
    if (!dynamics_.completeFromCloseBy(motion_)) continue;
    if (!trajectory.has_velocities) table.velocities.row(row) = motion_.qd;
    table.accelerations.row(row) = motion_.qdd;
  }
}

}  // namespace virtual_work_dynamics
