#include "ros/motion_completer.h"

#include <algorithm>

#include "dynamics/sample_rows.h"

namespace virtual_work_dynamics {

MotionCompleter::MotionCompleter(const Mechanism& mechanism, const Dynamics& dynamics,
                                 bool static_motion)
    : closed_(dynamics.closed()),
      static_motion_(static_motion),
      closures_determine_(dynamics.closuresDetermine()),
      actuated_(dynamics.actuated()),
      rule_(mechanism, dynamics),
      joint_states_(mechanism, dynamics),
      trajectories_(mechanism, dynamics),
      samples_(mechanism, dynamics),
      needed_(actuated_),
      seen_(actuated_.size(), false),
      motion_(dynamics.coordinates()) {
  const bool none_passive = std::count(needed_.begin(), needed_.end(), false) == 0;
  passive_given_ = none_passive || !closures_determine_;
  if (passive_given_) needed_.assign(needed_.size(), true);
}

bool MotionCompleter::saw(const int* coordinates, int count) {
  if (passive_given_) return false;
  for (int i = 0; i < count; ++i) seen_[static_cast<std::size_t>(coordinates[i])] = true;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (!seen_[i] && !needed_[i]) return false;
  }
  passive_given_ = true;
  needed_.assign(needed_.size(), true);
  return true;
}

bool MotionCompleter::complete(Motion& motion, const Dynamics& dynamics,
                               Dynamics::Workspace& workspace) {
  if (!closed_) return true;
  evaluated_ = true;
  if (static_motion_) {
    motion.qd.setZero();
    motion.qdd.setZero();
  }
  if (passive_given_) {
    joint_states_.moveTo(motion.q);
    return true;
  }
  if (joint_states_.complete(motion, dynamics, workspace)) return true;
  motion_ = motion;
  return false;
}

std::vector<bool> MotionCompleter::given(const TrajectoryMotion& trajectory) const {
  std::vector<bool> given = actuated_;  // actuated ones left out rest where seen last
  for (const int i : trajectory.coordinates) given[static_cast<std::size_t>(i)] = true;
  return given;
}

std::optional<Rejection> MotionCompleter::check(const TrajectoryMotion& trajectory) const {
  const std::optional<std::string> problem = rule_.problem(given(trajectory));
  if (!problem) return std::nullopt;
  return Rejection{DropReason::kPassiveJoints, *problem};
}

void MotionCompleter::complete(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                               Dynamics::Workspace& workspace) {
  trajectory.open.clear();
  if (!closures_determine_) return;
  if (!rule_.givesPassive(given(trajectory))) {
    follow(trajectory, dynamics, workspace);
  } else if (!static_motion_ && !trajectory.completion.empty()) {
    completeDerivatives(trajectory, dynamics, workspace);
  } else {
    return;
  }
  if (!trajectory.completion.empty()) trajectory.completion += "; passive joints from the closures";
}

void MotionCompleter::startSamples(const TrajectoryMotion& trajectory) {
  if (!closures_determine_) return;
  samples_give_passive_ = rule_.givesPassive(given(trajectory));
  if (evaluated_) samples_.moveTo(joint_states_.position());
}

bool MotionCompleter::completeSample(Motion& motion, const Dynamics& dynamics,
                                     Dynamics::Workspace& workspace) {
  if (!closures_determine_) return true;
  if (static_motion_) {
    motion.qd.setZero();
    motion.qdd.setZero();
  }
  if (samples_give_passive_) samples_.moveTo(motion.q);
  if (samples_.complete(motion, dynamics, workspace)) return true;
  motion_ = motion;
  return false;
}

void MotionCompleter::follow(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                             Dynamics::Workspace& workspace) {
  MotionTable& table = trajectory.table;
  if (evaluated_) trajectories_.moveTo(joint_states_.position());
  trajectory.open.assign(trajectory.stamps_ns.size(), false);
  for (std::size_t i = 0; i < trajectory.open.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    takeRow(table, i, motion_);
    if (static_motion_) {
      motion_.qd.setZero();
      motion_.qdd.setZero();
    }
    trajectory.open[i] = !trajectories_.complete(motion_, dynamics, workspace);
    if (trajectory.open[i] && trajectory.problem.empty()) {
      trajectory.problem = problem(dynamics, workspace);
    }
    table.positions.row(row) = motion_.q;
    table.velocities.row(row) = motion_.qd;
    table.accelerations.row(row) = motion_.qdd;
  }
}

// Completes velocities and accelerations. Positions stay as they are given; where these are far
// from closing the loops, velocities and accelerations stay too, and the residuals show it.
void MotionCompleter::completeDerivatives(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                                          Dynamics::Workspace& workspace) {
  MotionTable& table = trajectory.table;
  for (Eigen::Index row = 0; row < table.positions.rows(); ++row) {
    takeRow(table, static_cast<std::size_t>(row), motion_);
    if (!dynamics.completeFromCloseBy(motion_, workspace)) continue;
    if (!trajectory.has_velocities) table.velocities.row(row) = motion_.qd;
    table.accelerations.row(row) = motion_.qdd;
  }
}

}  // namespace virtual_work_dynamics
