#include "core/loop_follower.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {
namespace {

// A position that is searched for from another, with no joint turned farther than this, rad, is on
// the same branch as that; shorter than any way from one branch to another but near singular ones.
constexpr double kFar = 0.3;
constexpr double kTurn = 6.283185307179586476925286766559;

bool wraps(const Mechanism& mechanism, const Joint& wanted) {
  const auto& joints = mechanism.joints();
  return wanted.type == JointType::kContinuous &&
         std::none_of(joints.begin(), joints.end(), [&](const Joint& joint) {
           return joint.mimics && joint.coordinate == wanted.coordinate;
         });
}

}  // namespace

// How often a way is halved at most; whole turns between two positions come down to a tenth of
// kFar.
constexpr int LoopFollower::kHalvings;

LoopFollower::LoopFollower(const Mechanism& mechanism, const ClosedLoopDynamics& dynamics)
    : completed_(dynamics.coordinates()), before_(dynamics.assembly()), closed_(before_) {
  for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
    const Joint& joint = mechanism.joints()[static_cast<std::size_t>(mechanism.coordinates()[i])];
    const auto index = static_cast<Eigen::Index>(i);
    if (joint.type != JointType::kPrismatic) turning_.push_back(index);
    if (!dynamics.actuated()[i]) continue;
    given_.push_back(index);
    wraps_.push_back(wraps(mechanism, joint));
  }
  targets_.fill(closed_);
}

bool LoopFollower::complete(Motion& motion, ClosedLoopDynamics& dynamics) {
  before_ = closed_;
  setNearest(motion);
  const bool closes = follow(motion, kHalvings, dynamics);
  if (!closes) closed_ = before_;
  // What was given stays as it is, with its whole turns.
  for (const Eigen::Index i : given_) completed_.q[i] = motion.q[i];
  motion = completed_;
  return closes;
}

// What the motion gives, without the whole turns by which drivers wrap: the way back over a whole
// turn may pass singular positions.
void LoopFollower::setNearest(const Motion& motion) {
  Eigen::VectorXd& nearest = targets_[kHalvings];
  nearest = closed_;
  for (std::size_t i = 0; i < given_.size(); ++i) {
    double& position = nearest[given_[i]];
    const double turns = wraps_[i] ? std::round((motion.q[given_[i]] - position) / kTurn) : 0;
    position = motion.q[given_[i]] - kTurn * turns;
  }
}

// Brings what the motion gives to the target, and the passive joints along.
bool LoopFollower::follow(const Motion& motion, int halvings, ClosedLoopDynamics& dynamics) {
  const auto place = static_cast<std::size_t>(halvings);
  completed_ = motion;
  completed_.q = closed_;
  for (const Eigen::Index i : given_) completed_.q[i] = targets_[place][i];
  const bool closes = dynamics.complete(completed_);
  if (halvings > 0 && (!closes || turnsFar(closed_, completed_.q))) {
    targets_[place - 1] = (closed_ + targets_[place]) / 2;
    follow(motion, halvings - 1, dynamics);  // a position in between may be singular
    targets_[place - 1] = targets_[place];
    return follow(motion, halvings - 1, dynamics);
  }
  if (closes) closed_ = completed_.q;
  return closes;
}

bool LoopFollower::turnsFar(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  return std::any_of(turning_.begin(), turning_.end(),
                     [&](Eigen::Index i) { return std::abs(to[i] - from[i]) > kFar; });
}

}  // namespace virtual_work_dynamics
