#include "virtual_work_dynamics/passive_joints.h"

#include <algorithm>
#include <cmath>

#include "dynamics/compiled_dynamics.h"
#include "loops/given_loops.h"
#include "scene/input_checks.h"

namespace virtual_work_dynamics {
namespace {

// Angle, rad: a position that a search finds from another without turning any joint farther is on
// the same branch. Except near singular positions, every way from one branch to another is longer.
constexpr double kFar = 0.3;
// Number of shortest pieces of a way that may end where the loops cannot be closed, as happens at
// singular positions, before the rest of the way is given up.
constexpr int kMostFailures = 4;
// How far a way is continued, in lengths of its last piece.
constexpr double kFurthest = 4;
// Largest squares of what rates and accelerations miss of the way of what is given, relative to
// that way, and of what accelerations add, relative to what rates do: beyond, they do not lead
// there.
constexpr double kLeadsThere = 1e-2;
constexpr double kMostlyLinear = 0.25;
constexpr double kTurn = 6.283185307179586476925286766559;

// Whether each coordinate is mimicked, so that its whole turns are not without effect.
std::vector<bool> mimicked(const Mechanism& mechanism) {
  std::vector<bool> result(mechanism.coordinates().size(), false);
  for (const Joint& joint : mechanism.joints()) {
    if (joint.mimics) result[static_cast<std::size_t>(joint.coordinate)] = true;
  }
  return result;
}

}  // namespace

// The most halvings of a way; they bring whole turns between two positions down to a tenth of kFar.
constexpr int PassiveJoints::kHalvings;
constexpr int PassiveJoints::kMostSearches;

PassiveJoints::PassiveJoints(const Mechanism& mechanism, const Dynamics& dynamics)
    : PassiveJoints(mechanism, dynamics, dynamics.given()) {}

PassiveJoints::PassiveJoints(const Mechanism& mechanism, const Dynamics& dynamics,
                             const Given& given)
    : given_(given),
      coordinates_(dynamics.coordinates()),
      completed_(coordinates_, mechanism.orientations()),
      driven_(static_cast<Eigen::Index>(given.drivenNumbers())),
      references_(completed_.orientations),
      position_(dynamics.assembly()),
      missed_(position_) {
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    const int angles = mechanism.anglesOf(i);
    if (!given.coordinates[static_cast<std::size_t>(angles)]) found_turns_.push_back({i, angles});
  }
  const std::vector<bool> is_mimicked = mimicked(mechanism);
  for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
    const Joint& joint = mechanism.joints()[static_cast<std::size_t>(mechanism.coordinates()[i])];
    const auto index = static_cast<Eigen::Index>(i);
    const Dynamics::Impl& plan = *dynamics.impl_;
    if (joint.type != JointType::kPrismatic && plan.bends[i]) turning_.push_back(index);
    if (!given.coordinates[i]) continue;
    fixed_.push_back(index);
    wraps_.push_back(joint.type == JointType::kContinuous && !is_mimicked[i] && !plan.coupled[i]);
  }
  if (driven_.q.size() > 0 && dynamics.closed()) driven_loops_ = dynamics.givenLoops(given);
  for (Eigen::Index i = 0; i < driven_.q.size(); ++i) {
    const auto closure = static_cast<std::size_t>(i);
    fixed_.push_back(coordinates_ + i);
    wraps_.push_back(driven_loops_ && closure < given.closures.size() &&
                     driven_loops_->turns(closure));
  }
  closed_.setZero(coordinates_ + driven_.q.size());
  moveTo(position_);
  before_ = found_ = closed_;
  targets_.fill(closed_);
}

PassiveJoints::~PassiveJoints() = default;
PassiveJoints::PassiveJoints(PassiveJoints&&) noexcept = default;
PassiveJoints& PassiveJoints::operator=(PassiveJoints&&) noexcept = default;

void PassiveJoints::moveTo(const Eigen::VectorXd& position,
                           const std::vector<Eigen::Quaterniond>& references) {
  position_ = position;
  if (!references.empty()) references_ = references;
  closed_.head(coordinates_) = position;
  if (driven_loops_) {
    driven_loops_->getDriven(position, closed_.tail(closed_.size() - coordinates_));
  }
  previous_ = closed_;
  rates_.setZero(closed_.size());
  accelerations_ = rates_;
}

bool PassiveJoints::complete(Motion& motion, const Dynamics& dynamics,
                             Dynamics::Workspace& workspace) {
  return complete(motion, Motion(), dynamics, workspace);
}

bool PassiveJoints::complete(Motion& motion, const Motion& driven, const Dynamics& dynamics,
                             Dynamics::Workspace& workspace) {
  requireLengths(motion, coordinates_);
  requireLengths(driven, driven_.q.size());
  if (!dynamics.closed()) return true;
  if (!motion.orientations.empty()) completed_.orientations = motion.orientations;
  completed_.root = motion.root;
  for (const FoundTurn& turn : found_turns_) {
    completed_.orientations[turn.orientation] = references_[turn.orientation];
  }
  before_ = closed_;
  setNearest(motion, driven);
  searches_ = failures_ = 0;
  bool closes = follow(motion, kHalvings, dynamics, workspace);
  // Searches from where the way ends, as the caller wants to know how far the loops stay open at
  // the position itself. Where they close after all, the way there led through a gap.
  if (givenUp()) closes = search(motion, targets_[kHalvings], dynamics, workspace);
  closed_ = closes ? found_ : before_;
  position_ = closed_.head(coordinates_);
  if (!closes || givenUp()) previous_ = closed_;
  rates_.setZero();
  accelerations_.setZero();
  if (closes) {
    rates_ << completed_.qd, driven_.qd;
    accelerations_ << completed_.qdd, driven_.qdd;
  }
  // Given positions stay as they are, with their whole turns.
  for (const Eigen::Index i : fixed_) {
    if (i < coordinates_) completed_.q[i] = motion.q[i];
  }
  motion = completed_;
  if (closes) foldTurns();
  return closes;
}

// Lets angles that are large start anew from where they lead, before they become singular. The next
// search starts without a guess of how they go on.
void PassiveJoints::foldTurns() {
  constexpr double kLarge = 0.5;  // rad; singular is a quarter turn
  for (const FoundTurn& turn : found_turns_) {
    const Eigen::Vector3d angles = position_.segment<3>(turn.angles);
    if (angles.cwiseAbs().maxCoeff() < kLarge) continue;
    Eigen::Quaterniond& reference = references_[turn.orientation];
    for (int i = 0; i < 3; ++i) {
      reference = reference * Eigen::AngleAxisd(angles[i], Eigen::Vector3d::Unit(i));
    }
    reference.normalize();
    for (Eigen::VectorXd* values : {&position_, &closed_, &previous_, &rates_, &accelerations_}) {
      values->segment<3>(turn.angles).setZero();
    }
  }
}

std::string PassiveJoints::whyOpen(const Dynamics& dynamics, Dynamics::Workspace& workspace) const {
  if (!driven_loops_) return dynamics.whyOpen(completed_, given_.coordinates, workspace);
  return driven_loops_->whyOpen(completed_.q);
}

// Takes the given positions without the whole turns by which drivers wrap: the way back over a
// whole turn may pass singular positions. A quaternion and its opposite are the same orientation.
void PassiveJoints::setNearest(const Motion& motion, const Motion& driven) {
  driven_ = driven;
  for (std::size_t k = 0; k < given_.links.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(given_.closures.size() + Given::kPoseNumbers * k);
    if (driven.q.segment<4>(first + 3).dot(closed_.segment<4>(coordinates_ + first + 3)) >= 0) {
      continue;
    }
    for (Eigen::VectorXd* numbers : {&driven_.q, &driven_.qd, &driven_.qdd}) {
      numbers->segment<4>(first + 3) *= -1;
    }
  }
  Eigen::VectorXd& nearest = targets_[kHalvings];
  nearest = closed_;
  for (std::size_t i = 0; i < fixed_.size(); ++i) {
    const Eigen::Index place = fixed_[i];
    const double wanted = place < coordinates_ ? motion.q[place] : driven_.q[place - coordinates_];
    const double turns = wraps_[i] ? std::round((wanted - nearest[place]) / kTurn) : 0;
    nearest[place] = wanted - kTurn * turns;
  }
}

// Moves what is given to the target and takes the other joints along.
bool PassiveJoints::follow(const Motion& motion, int halvings, const Dynamics& dynamics,
                           Dynamics::Workspace& workspace) {
  const auto place = static_cast<std::size_t>(halvings);
  if (givenUp()) return false;
  const bool closes = search(motion, targets_[place], dynamics, workspace);
  if (halvings > 0 && (!closes || turnsFar(closed_, found_))) {
    targets_[place - 1] = (closed_ + targets_[place]) / 2;
    follow(motion, halvings - 1, dynamics, workspace);  // a position in between may be singular
    targets_[place - 1] = targets_[place];
    return follow(motion, halvings - 1, dynamics, workspace);
  }
  if (closes) {
    previous_ = closed_;
    closed_ = found_;
  }
  if (!closes) ++failures_;
  return closes;
}

// Searches for `target` from where the motion leads that was found last, else from the position
// that was found last, and where that fails from where the way to it leads on: past a flat position
// the links would otherwise have to turn back on each other.
bool PassiveJoints::search(const Motion& motion, const Eigen::VectorXd& target,
                           const Dynamics& dynamics, Dynamics::Workspace& workspace) {
  ++searches_;
  if (predict(target) && searchFound(motion, target, dynamics, workspace)) return true;
  if (searchFrom(0, motion, target, dynamics, workspace)) return true;
  double along = 0, square = 0;
  for (const Eigen::Index i : fixed_) {
    const double step = closed_[i] - previous_[i];
    along += step * (target[i] - closed_[i]);
    square += step * step;
  }
  if (square == 0 || !(std::abs(along) <= kFurthest * square)) return false;
  missed_.swap(completed_.q);
  if (searchFrom(along / square, motion, target, dynamics, workspace)) return true;
  completed_.q.swap(missed_);  // the better start for telling what stays open
  return false;
}

// Sets found_ to where the rates and accelerations found last lead in the time that what is given
// takes to get to the target. Returns false where they do not lead there.
bool PassiveJoints::predict(const Eigen::VectorXd& target) {
  double along = 0, square = 0;
  for (const Eigen::Index i : fixed_) {
    along += rates_[i] * (target[i] - closed_[i]);
    square += rates_[i] * rates_[i];
  }
  if (!(along > 0)) return false;
  double time = along / square;
  // One step of the Gauss-Newton method takes the accelerations into account.
  double corrected = 0, missed = 0, whole = 0;
  along = square = 0;
  for (const Eigen::Index i : fixed_) {
    const double rate = rates_[i] + time * accelerations_[i], way = target[i] - closed_[i];
    along += rate * (way - time * (rates_[i] + time / 2 * accelerations_[i]));
    square += rate * rate;
    whole += way * way;
  }
  if (square > 0) corrected = along / square;
  if (!(std::abs(corrected) < time / 2)) return false;
  time += corrected;
  for (const Eigen::Index i : fixed_) {
    const double left = target[i] - closed_[i] - time * (rates_[i] + time / 2 * accelerations_[i]);
    missed += left * left;
  }
  if (!(missed <= kLeadsThere * whole)) return false;
  found_ = closed_ + time * rates_;
  const double linear = (found_ - closed_).squaredNorm();
  found_ += time * time / 2 * accelerations_;
  return (found_ - closed_ - time * rates_).squaredNorm() <= kMostlyLinear * linear;
}

bool PassiveJoints::searchFrom(double further, const Motion& motion, const Eigen::VectorXd& target,
                               const Dynamics& dynamics, Dynamics::Workspace& workspace) {
  found_ = closed_ + further * (closed_ - previous_);
  return searchFound(motion, target, dynamics, workspace);
}

// Searches from found_.
bool PassiveJoints::searchFound(const Motion& motion, const Eigen::VectorXd& target,
                                const Dynamics& dynamics, Dynamics::Workspace& workspace) {
  for (const Eigen::Index i : fixed_) found_[i] = target[i];
  completed_.q = found_.head(coordinates_);
  completed_.qd = motion.qd;
  completed_.qdd = motion.qdd;
  driven_.q = found_.tail(driven_.q.size());
  const bool closes = driven_loops_
                          ? driven_loops_->complete(completed_, driven_)
                          : dynamics.completeFromCloseBy(completed_, given_.coordinates, workspace);
  found_.head(coordinates_) = completed_.q;
  return closes;
}

bool PassiveJoints::givenUp() const {
  return failures_ >= kMostFailures || searches_ >= kMostSearches - 1;
}

bool PassiveJoints::turnsFar(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  return std::any_of(turning_.begin(), turning_.end(),
                     [&](Eigen::Index i) { return std::abs(to[i] - from[i]) > kFar; });
}

}  // namespace virtual_work_dynamics
