#include "virtual_work_dynamics/passive_joints.h"

#include <algorithm>
#include <cmath>

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
    : completed_(dynamics.coordinates()),
      before_(dynamics.assembly()),
      closed_(before_),
      previous_(before_),
      missed_(before_) {
  const std::vector<bool> is_mimicked = mimicked(mechanism);
  for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
    const Joint& joint = mechanism.joints()[static_cast<std::size_t>(mechanism.coordinates()[i])];
    const auto index = static_cast<Eigen::Index>(i);
    if (joint.type != JointType::kPrismatic) turning_.push_back(index);
    if (!dynamics.actuated()[i]) continue;
    given_.push_back(index);
    wraps_.push_back(joint.type == JointType::kContinuous && !is_mimicked[i]);
  }
  targets_.fill(closed_);
}

bool PassiveJoints::complete(Motion& motion, const Dynamics& dynamics,
                             Dynamics::Workspace& workspace) {
  requireLengths(motion, dynamics.coordinates());
  if (!dynamics.closed()) return true;
  before_ = closed_;
  setNearest(motion);
  searches_ = failures_ = 0;
  bool closes = follow(motion, kHalvings, dynamics, workspace);
  // Searches from where the way ends, as the caller wants to know how far the loops stay open at
  // the position itself. Where they close after all, the way there led through a gap.
  if (givenUp()) closes = search(motion, targets_[kHalvings], dynamics, workspace);
  closed_ = closes ? completed_.q : before_;
  if (!closes || givenUp()) previous_ = closed_;
  // Given positions stay as they are, with their whole turns.
  for (const Eigen::Index i : given_) completed_.q[i] = motion.q[i];
  motion = completed_;
  return closes;
}

// Takes the given positions without the whole turns by which drivers wrap: the way back over a
// whole turn may pass singular positions.
void PassiveJoints::setNearest(const Motion& motion) {
  Eigen::VectorXd& nearest = targets_[kHalvings];
  nearest = closed_;
  for (std::size_t i = 0; i < given_.size(); ++i) {
    double& position = nearest[given_[i]];
    const double turns = wraps_[i] ? std::round((motion.q[given_[i]] - position) / kTurn) : 0;
    position = motion.q[given_[i]] - kTurn * turns;
  }
}

// Moves the given joints to the target and takes the passive joints along.
bool PassiveJoints::follow(const Motion& motion, int halvings, const Dynamics& dynamics,
                           Dynamics::Workspace& workspace) {
  const auto place = static_cast<std::size_t>(halvings);
  if (givenUp()) return false;
  const bool closes = search(motion, targets_[place], dynamics, workspace);
  if (halvings > 0 && (!closes || turnsFar(closed_, completed_.q))) {
    targets_[place - 1] = (closed_ + targets_[place]) / 2;
    follow(motion, halvings - 1, dynamics, workspace);  // a position in between may be singular
    targets_[place - 1] = targets_[place];
    return follow(motion, halvings - 1, dynamics, workspace);
  }
  if (closes) {
    previous_ = closed_;
    closed_ = completed_.q;
  }
  if (!closes) ++failures_;
  return closes;
}

// Searches for `target` from the position that was found last, and where that fails from where the
// way to it leads on: past a flat position the links would otherwise have to turn back on each
// other.
bool PassiveJoints::search(const Motion& motion, const Eigen::VectorXd& target,
                           const Dynamics& dynamics, Dynamics::Workspace& workspace) {
  ++searches_;
  start(motion, target, 0);
  if (dynamics.completeFromCloseBy(completed_, workspace)) return true;
  double along = 0, square = 0;
  for (const Eigen::Index i : given_) {
    const double step = closed_[i] - previous_[i];
    along += step * (target[i] - closed_[i]);
    square += step * step;
  }
  if (square == 0 || !(std::abs(along) <= kFurthest * square)) return false;
  missed_.swap(completed_.q);
  start(motion, target, along / square);
  if (dynamics.completeFromCloseBy(completed_, workspace)) return true;
  completed_.q.swap(missed_);  // the better start for telling what stays open
  return false;
}

void PassiveJoints::start(const Motion& motion, const Eigen::VectorXd& target, double further) {
  completed_ = motion;
  completed_.q = closed_ + further * (closed_ - previous_);
  for (const Eigen::Index i : given_) completed_.q[i] = target[i];
}

bool PassiveJoints::givenUp() const {
  return failures_ >= kMostFailures || searches_ >= kMostSearches - 1;
}

bool PassiveJoints::turnsFar(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  return std::any_of(turning_.begin(), turning_.end(),
                     [&](Eigen::Index i) { return std::abs(to[i] - from[i]) > kFar; });
}

}  // namespace virtual_work_dynamics
