#include "ros/motion_completer.h"

#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/motion_start.h"
#include "motion/table_row.h"
#include "ros/given_lengths.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

std::vector<bool> either(std::vector<bool> one, const std::vector<bool>& other) {
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = one[i] || other[i];
  return one;
}

std::vector<bool> without(std::vector<bool> one, const std::vector<bool>& other) {
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = one[i] && !other[i];
  return one;
}

// Of all actuators that could follow, if joints are given.
FollowingMotors motorsOf(const Mechanism& mechanism, const Scene& scene,
                         const std::vector<bool>& driven) {
  std::vector<bool> given(driven.size(), true);
  for (const auto& [joint, actuators] : scene.actuators_of) {
    for (const std::string& name : actuators) {
      const auto place = static_cast<std::size_t>(mechanism.coordinateIndex(name));
      given[place] = driven[place];
    }
  }
  return FollowingMotors(mechanism, scene, given);
}

std::vector<bool> namedBy(const TrajectoryMotion& trajectory, std::size_t coordinates) {
  std::vector<bool> named(coordinates, false);
  for (const int i : trajectory.coordinates) named[static_cast<std::size_t>(i)] = true;
  return named;
}

}  // namespace

constexpr double MotionCompleter::kNearlyClosed;

MotionCompleter::MotionCompleter(const Mechanism& mechanism, const Scene& scene,
                                 const Dynamics& dynamics, double tolerance, double drive_start)
    : mechanism_(mechanism),
      scene_(scene),
      dynamics_(dynamics),
      closed_(dynamics.closed()),
      static_motion_(scene.static_motion),
      closures_determine_(dynamics.closuresDetermine() &&
                          givenLengths(mechanism, scene, dynamics.given()).empty()),
      nearly_closed_(std::max(tolerance, kNearlyClosed)),
      usual_(dynamics.given()),
      rule_(mechanism, dynamics),
      without_lengths_(withoutLengths(mechanism, scene, usual_)),
      lengths_(givenLengths(mechanism, scene, usual_)),
      length_motion_(static_cast<Eigen::Index>(lengths_.size())),
      driven_(static_cast<Eigen::Index>(usual_.drivenNumbers())),
      drives_(mechanism, scene, without_lengths_, drive_start),
      motors_(motorsOf(mechanism, scene, drives_.coordinates())),
      joint_states_(mechanism, dynamics),
      trajectories_(mechanism, dynamics),
      samples_(mechanism, dynamics),
      all_given_((GivenJoints::givesAll(usual_) || dynamics.closureNames().empty()) &&
                 usual_.drivenNumbers() == 0),
      needed_(usual_.coordinates),
      seen_(needed_.size(), false),
      motion_(dynamics.coordinates(), dynamics.orientations()) {
  const std::vector<bool> joints_and_motors = either(needed_, motors_.coordinates());
  // What the closures complete is nothing that follows beside them.
  if (!all_given_ && std::count(joints_and_motors.begin(), joints_and_motors.end(), false) == 0) {
    motors_ = noMotors();
  }
  if (all_given_) needed_ = without(std::vector<bool>(needed_.size(), true), motors_.coordinates());
  for (std::size_t i = 0; i < needed_.size(); ++i) {
    if (drives_.coordinates()[i]) needed_[i] = false;
  }
  needed_.resize(needed_.size() + lengths_.size(), true);
  needs_clock_ = drives_.any() && std::count(needed_.begin(), needed_.end(), true) == 0;
}

bool MotionCompleter::saw(const int* coordinates, int count) {
  if (needs_clock_) {
    needs_clock_ = false;
    for (int i = 0; i < count; ++i) needed_[static_cast<std::size_t>(coordinates[i])] = true;
    return true;
  }
  if (all_given_) return motors_.any() && sawMotors(coordinates, count);
  if (drives_.any() || !lengths_.empty()) return false;
  for (int i = 0; i < count; ++i) seen_[static_cast<std::size_t>(coordinates[i])] = true;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (!seen_[i] && !needed_[i] && !motors_.coordinates()[i]) return false;
  }
  all_given_ = true;
  needed_ = without(std::vector<bool>(needed_.size(), true), motors_.coordinates());
  return true;
}

FollowingMotors MotionCompleter::noMotors() const {
  return FollowingMotors(mechanism_, scene_, std::vector<bool>(usual_.coordinates.size(), true));
}

// Actuators follow no longer once joint states have shown all that do.
bool MotionCompleter::sawMotors(const int* coordinates, int count) {
  for (int i = 0; i < count; ++i) seen_[static_cast<std::size_t>(coordinates[i])] = true;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (motors_.coordinates()[i] && !seen_[i]) return false;
  }
  needed_ = either(needed_, motors_.coordinates());
  motors_ = noMotors();
  return true;
}

bool MotionCompleter::measures() const {
  for (std::size_t i = 0; i < usual_.coordinates.size(); ++i) {
    if (usual_.coordinates[i] && !drives_.coordinates()[i]) return true;
  }
  return !lengths_.empty();
}

bool MotionCompleter::complete(Motion& motion, std::int64_t stamp_ns, const Dynamics& dynamics,
                               Dynamics::Workspace& workspace) {
  if (!drives_.set(stamp_ns, motion)) return false;
  if (!closed_) return true;
  if (static_motion_) {
    motion.qd.setZero();
    motion.qdd.setZero();
  }
  if (all_given_) {
    motors_.set(motion);
    return true;
  }
  setDriven();
  if (!started_) startBy(motion);
  evaluated_ = true;
  latest_ = &joint_states_;
  return joint_states_.complete(motion, driven_, dynamics, workspace);
}

void MotionCompleter::setDriven() {
  const Motion& of_drives = drives_.numbers();
  const Eigen::Index drives = of_drives.q.size(), lengths = length_motion_.q.size();
  driven_.q.head(drives) = of_drives.q;
  driven_.qd.head(drives) = of_drives.qd;
  driven_.qdd.head(drives) = of_drives.qdd;
  driven_.q.tail(lengths) = length_motion_.q;
  if (static_motion_) return;
  driven_.qd.tail(lengths) = length_motion_.qd;
  driven_.qdd.tail(lengths) = length_motion_.qdd;
}

const MotionFit::Outcome& MotionCompleter::fit(MotionFit& fit, Motion& motion,
                                               MotionCovariance* covariance,
                                               const Eigen::VectorXd& noise) const {
  motors_.set(motion);
  if (covariance) motors_.loosen(*covariance);
  return fit.fit(motion, covariance, noise, !static_motion_);
}

void MotionCompleter::complete(MotionCovariance& covariance) const {
  if (all_given_) motors_.set(covariance);
}

void MotionCompleter::startBy(const Motion& motion) {
  started_ = true;
  try {
    const Scene started = startedBy(mechanism_, scene_, {usual_, motion, driven_});
    joint_states_.moveTo(Dynamics(mechanism_, started, Request()).assembly());
  } catch (const AssemblyError&) {
    // The loops are closed from the scene's assembly, and complete() tells how far they stay open.
  }
}

void MotionCompleter::took(const Motion& motion, const Results& results) {
  if (!closed_ || !all_given_) return;
  const std::vector<ClosureResidual>& relative = results.loops.relative_residuals;
  const auto worst = std::max_element(
      relative.begin(), relative.end(),
      [](const auto& one, const auto& other) { return one.position < other.position; });
  if (worst == relative.end() || worst->position <= nearly_closed_) {
    joint_states_.moveTo(motion.q, motion.orientations);
    evaluated_ = true;
    return;
  }
  if (open_) return;
  open_ = true;
  open_closure_ = static_cast<std::size_t>(worst - relative.begin());
  open_relative_ = *worst;
  open_by_ = results.loops.residuals[open_closure_];
}

std::optional<std::string> MotionCompleter::openStates() {
  if (!open_ || open_told_) return std::nullopt;
  open_told_ = true;
  return "the positions leave " + dynamics_.closureLabel(open_closure_) + " open by " +
         numberText(open_by_.position) + " m or rad, " + numberText(open_relative_.position) +
         " relative, more than " + numberText(nearly_closed_) +
         ": passive joints of trajectories do not start from there, but from " +
         (evaluated_ ? "where the loops were closed last" : "the assembly");
}

// What is given with these coordinates.
Given MotionCompleter::with(std::vector<bool> coordinates) const {
  Given given;
  given.coordinates = either(std::move(coordinates), drives_.coordinates());
  given.closures = without_lengths_.closures;  // driven ones
  return given;
}

MotionCompleter::Choice MotionCompleter::choose(const std::vector<bool>& named) const {
  const Given given = with(either(GivenJoints::resting(dynamics_), named));
  std::optional<std::string> problem = rule_.problem(given);
  if (!problem) {
    const bool all = GivenJoints::givesAll(given) && !GivenJoints::givesAll(with(named));
    if (const auto joints = all ? chooseJoints(named) : std::nullopt) return *joints;
    return {given, problem, {}};
  }
  const Given alone = with(named);
  if (!rule_.problem(alone)) return {alone, std::nullopt, {}};
  if (const auto joints = chooseJoints(named)) return *joints;
  return {given, problem, {}};
}

// All joints, named or at rest, from which actuators follow that are not named.
std::optional<MotionCompleter::Choice> MotionCompleter::chooseJoints(
    const std::vector<bool>& named) const {
  const FollowingMotors all = motorsOf(mechanism_, scene_, drives_.coordinates());
  if (!all.any()) return std::nullopt;
  const std::vector<bool> joints =
      either(without(GivenJoints::resting(dynamics_), all.coordinates()), named);
  const FollowingMotors motors(mechanism_, scene_, with(joints).coordinates);
  const Given given = with(either(joints, motors.coordinates()));
  if (!motors.any() || rule_.problem(given)) return std::nullopt;
  return Choice{given, std::nullopt, motors};
}

const MotionCompleter::Choice& MotionCompleter::chosenBy(const TrajectoryMotion& trajectory) {
  const std::vector<bool> named = namedBy(trajectory, usual_.coordinates.size());
  if (named_ != named) {
    choice_ = choose(named);
    named_ = named;
  }
  return choice_;
}

std::optional<Rejection> MotionCompleter::check(const TrajectoryMotion& trajectory) {
  const Choice& choice = chosenBy(trajectory);
  if (choice.problem) return Rejection{DropReason::kPassiveJoints, *choice.problem};
  const auto turn = turnIn(choice.given.coordinates);
  if (!turn) return std::nullopt;
  return Rejection{DropReason::kOrientation,
                   "it gives an angle of " + inQuotes(mechanism_.freeJoint(*turn).name) +
                       ", a joint that turns freely, whose orientation the closures tell"};
}

std::optional<std::size_t> MotionCompleter::turnIn(const std::vector<bool>& given) const {
  for (std::size_t i = 0; i < mechanism_.orientations(); ++i) {
    const auto first = given.begin() + mechanism_.anglesOf(i);
    if (std::find(first, first + 3, true) != first + 3) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> MotionCompleter::turnToGive() const {
  return turnIn(GivenJoints::resting(dynamics_));
}

void MotionCompleter::setGiven(const Given& given, PassiveJoints& joints) const {
  const Given& before = joints.given();
  if (before.coordinates == given.coordinates && before.closures == given.closures) return;
  const Eigen::VectorXd position = joints.position();
  const std::vector<Eigen::Quaterniond> references = joints.references();
  joints = PassiveJoints(mechanism_, dynamics_, given);
  joints.moveTo(position, references);
}

void MotionCompleter::complete(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                               Dynamics::Workspace& workspace) {
  trajectory.open.clear();
  trajectory.undriven.clear();
  drive(trajectory);
  if (!closed_) return;
  const Given& given = chosenBy(trajectory).given;
  choice_.motors.set(trajectory.table);
  if (!GivenJoints::givesAll(given) || given.drivenNumbers() > 0) {
    setGiven(given, trajectories_);
    follow(trajectory, dynamics, workspace);
  } else if (closures_determine_ && !static_motion_ && !trajectory.completion.empty()) {
    completeDerivatives(trajectory, dynamics, workspace);
  } else {
    return;
  }
  if (!trajectory.completion.empty()) trajectory.completion += "; passive joints from the closures";
}

// Sets what is driven at the points. Those at which it is not known are open.
void MotionCompleter::drive(TrajectoryMotion& trajectory) {
  if (!drives_.any() || trajectory.stamps_ns.empty()) return;
  drives_.beginTrajectory(trajectory.stamps_ns.front());
  MotionTable& table = trajectory.table;
  for (std::size_t i = 0; i < trajectory.stamps_ns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    takeRow(table, i, motion_);
    if (!drives_.set(trajectory.stamps_ns[i], motion_)) {
      for (std::vector<bool>* points : {&trajectory.open, &trajectory.undriven}) {
        points->resize(trajectory.stamps_ns.size(), false);
        (*points)[i] = true;
      }
      if (trajectory.problem.empty()) trajectory.problem = drives_.problem();
    }
    table.positions.row(row) = motion_.q;
    table.velocities.row(row) = motion_.qd;
    table.accelerations.row(row) = motion_.qdd;
  }
}

void MotionCompleter::startSamples(const TrajectoryMotion& trajectory) {
  if (!trajectory.stamps_ns.empty()) drives_.beginTrajectory(trajectory.stamps_ns.front());
  if (!closed_) return;
  const Given& given = chosenBy(trajectory).given;
  samples_give_all_ = GivenJoints::givesAll(given) && given.drivenNumbers() == 0;
  samples_follow_ = closures_determine_ || !samples_give_all_;
  if (!samples_follow_) return;
  setGiven(samples_give_all_ ? usual_ : given, samples_);
  if (evaluated_) samples_.moveTo(joint_states_.position(), joint_states_.references());
}

bool MotionCompleter::completeSample(Motion& motion, std::int64_t stamp_ns,
                                     const Dynamics& dynamics, Dynamics::Workspace& workspace) {
  if (!drives_.set(stamp_ns, motion)) return false;
  if (!closed_) return true;
  choice_.motors.set(motion);
  if (!samples_follow_) return true;
  if (static_motion_) {
    motion.qd.setZero();
    motion.qdd.setZero();
  }
  if (samples_give_all_) samples_.moveTo(motion.q);
  latest_ = &samples_;
  return samples_.complete(motion, drives_.numbers(), dynamics, workspace);
}

void MotionCompleter::follow(TrajectoryMotion& trajectory, const Dynamics& dynamics,
                             Dynamics::Workspace& workspace) {
  MotionTable& table = trajectory.table;
  if (evaluated_) trajectories_.moveTo(joint_states_.position(), joint_states_.references());
  latest_ = &trajectories_;
  trajectory.open.assign(trajectory.stamps_ns.size(), false);
  const auto turns = static_cast<Eigen::Index>(motion_.orientations.size());
  table.orientations.resize(0, 0);  // all are found
  Eigen::MatrixXd orientations(table.positions.rows(), 4 * turns);
  for (std::size_t i = 0; i < trajectory.open.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    takeRow(table, i, motion_);
    if (static_motion_) {
      motion_.qd.setZero();
      motion_.qdd.setZero();
    }
    trajectory.open[i] = !drives_.set(trajectory.stamps_ns[i], motion_) ||
                         !trajectories_.complete(motion_, drives_.numbers(), dynamics, workspace);
    if (trajectory.open[i] && trajectory.problem.empty()) {
      trajectory.problem = problem(dynamics, workspace);
    }
    table.positions.row(row) = motion_.q;
    table.velocities.row(row) = motion_.qd;
    table.accelerations.row(row) = motion_.qdd;
    for (Eigen::Index turn = 0; turn < turns; ++turn) {
      orientations.row(row).segment<4>(4 * turn) =
          motion_.orientations[static_cast<std::size_t>(turn)].coeffs().transpose();
    }
  }
  table.orientations = std::move(orientations);
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
