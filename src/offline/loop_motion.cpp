#include "offline/loop_motion.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/number_text.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

// A position that is searched for from another, with no joint turned farther than this, rad, is on
// the same branch as that; shorter than any way from one branch to another but near singular ones.
constexpr double kFar = 0.3;
// How often a way is halved at most; whole turns between two rows come down to a tenth of kFar.
constexpr int kHalvings = 8;
constexpr double kTurn = 6.283185307179586476925286766559;

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string joined(const Names& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// All coordinates, or the actuated ones where no passive joint is given.
class Choice {
 public:
  Choice(const std::string& path, const Mechanism& mechanism, const ClosedLoopDynamics& dynamics)
      : path_(path), all_(mechanism.coordinateNames()), dynamics_(dynamics) {}

  Names operator()(const Names& given) const {
    Names actuated, passive_given, passive_missing;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const std::string& name = all_[i];
      if (dynamics_.actuated()[i]) {
        actuated.push_back(name);
      } else {
        (contains(given, name) ? passive_given : passive_missing).push_back(name);
      }
    }
    if (passive_missing.empty()) return all_;
    if (!dynamics_.actuatedClosures().empty()) {
      throw FileError(path_ + ": positions of " + joined(passive_missing) +
                      " are missing: where a closure is actuated (" +
                      joined(dynamics_.actuatedClosures()) + "), all joints must be given");
    }
    if (passive_given.empty()) return actuated;
    throw FileError(path_ + ": positions of the passive joints " + joined(passive_given) +
                    " are given, but not of " + joined(passive_missing) +
                    ": give those of all joints, or of the actuated ones only");
  }

 private:
  const std::string& path_;
  const Names& all_;
  const ClosedLoopDynamics& dynamics_;
};

Names namesOf(const std::vector<Closure>& closures) {
  Names names;
  for (const Closure& closure : closures) names.push_back(closure.name);
  return names;
}

bool wraps(const Mechanism& mechanism, const std::string& name) {
  const auto& joints = mechanism.joints();
  const Joint& wanted = joints[static_cast<std::size_t>(mechanism.jointIndex(name))];
  return wanted.type == JointType::kContinuous &&
         std::none_of(joints.begin(), joints.end(), [&](const Joint& joint) {
           return joint.mimics && joint.coordinate == wanted.coordinate;
         });
}

struct Level {
  const char* name;
  const char* unit;
  double ClosureResidual::*residual;
};

constexpr Level kLevels[] = {{"positions", "m or rad", &ClosureResidual::position},
                             {"velocities", "m/s or rad/s", &ClosureResidual::velocity},
                             {"accelerations", "m/s^2 or rad/s^2", &ClosureResidual::acceleration}};

}  // namespace

LoopMotion::LoopMotion(const std::string& path, const Mechanism& mechanism, const Scene& scene,
                       const ClosedLoopDynamics& dynamics, double tolerance)
    : closures_(namesOf(scene.closures)),
      tolerance_(tolerance),
      file_(readMotion(path, mechanism, Choice(path, mechanism, dynamics))),
      motion_(dynamics.coordinates()),
      completed_(dynamics.coordinates()) {
  const Names& all = mechanism.coordinateNames();
  const Names& joints = file_.table.joints;
  for (const std::string& name : joints) {
    coordinates_.push_back(std::find(all.begin(), all.end(), name) - all.begin());
    wraps_.push_back(wraps(mechanism, name));
  }
  positions_follow_ = joints.size() < all.size();
  if (dynamics.actuatedClosures().empty() && !closures_.empty() && !scene.static_motion) {
    velocities_follow_ = positions_follow_ || !file_.table.hasVelocities();
    accelerations_follow_ = positions_follow_ || !file_.table.hasAccelerations();
  }
  completeDerivatives(mechanism, scene, file_);
  Names follow;
  if (positions_follow_) follow.push_back("positions");
  if (velocities_follow_) follow.push_back("velocities");
  if (accelerations_follow_) follow.push_back("accelerations");
  if (!follow.empty()) {
    std::cerr << "note: " << path << ": of passive joints, by the closures: " << joined(follow)
              << "\n";
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto joint = static_cast<std::size_t>(mechanism.coordinates()[i]);
    if (mechanism.joints()[joint].type == JointType::kPrismatic) continue;
    turning_.push_back(static_cast<Eigen::Index>(i));
  }
  closed_ = dynamics.assembly();
}

void LoopMotion::compute(std::size_t row, ClosedLoopDynamics& dynamics) {
  take(row);
  if (positions_follow_ || velocities_follow_ || accelerations_follow_) {
    completePassive(row, dynamics);
  }
  dynamics.compute(motion_);
  checkLoops(row, dynamics);
}

void LoopMotion::take(std::size_t row) {
  const MotionTable& table = file_.table;
  const auto index = static_cast<Eigen::Index>(row);
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    motion_.q[coordinates_[i]] = table.positions(index, column);
    motion_.qd[coordinates_[i]] = table.velocities(index, column);
    motion_.qdd[coordinates_[i]] = table.accelerations(index, column);
  }
}

void LoopMotion::completePassive(std::size_t row, ClosedLoopDynamics& dynamics) {
  if (positions_follow_) {
    if (!follow(nearestPositions(), kHalvings, dynamics)) throwOpen(row, dynamics);
    const Eigen::VectorXd given = motion_.q;
    motion_.q = closed_;
    for (const Eigen::Index i : coordinates_) motion_.q[i] = given[i];
  } else {
    completed_ = motion_;
    if (!dynamics.complete(completed_)) throwOpen(row, dynamics);
  }
  if (velocities_follow_) motion_.qd = completed_.qd;
  if (accelerations_follow_) motion_.qdd = completed_.qdd;
}

// What the file gives, without the whole turns by which drivers wrap: the way back over a whole
// turn may pass singular positions.
Eigen::VectorXd LoopMotion::nearestPositions() const {
  Eigen::VectorXd positions = motion_.q;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    if (!wraps_[i]) continue;
    double& position = positions[coordinates_[i]];
    position -= kTurn * std::round((position - closed_[coordinates_[i]]) / kTurn);
  }
  return positions;
}

// Brings what the file gives to those positions, and the passive joints along.
bool LoopMotion::follow(const Eigen::VectorXd& positions, int halvings,
                        ClosedLoopDynamics& dynamics) {
  completed_ = motion_;
  completed_.q = closed_;
  for (const Eigen::Index i : coordinates_) completed_.q[i] = positions[i];
  const bool closes = dynamics.complete(completed_);
  if (halvings > 0 && (!closes || turnsFar(closed_, completed_.q))) {
    const Eigen::VectorXd middle = (closed_ + positions) / 2;
    follow(middle, halvings - 1, dynamics);  // a position in between may be singular
    return follow(positions, halvings - 1, dynamics);
  }
  if (closes) closed_ = completed_.q;
  return closes;
}

bool LoopMotion::turnsFar(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  return std::any_of(turning_.begin(), turning_.end(),
                     [&](Eigen::Index i) { return std::abs(to[i] - from[i]) > kFar; });
}

void LoopMotion::checkLoops(std::size_t row, const ClosedLoopDynamics& dynamics) const {
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    for (const Level& level : kLevels) {
      const double relative = dynamics.relativeResiduals()[i].*level.residual;
      if (relative <= tolerance_) continue;
      std::ostringstream text;
      text << file_.at(row) << ": the " << level.name << " violate closure '" << closures_[i]
           << "' by " << dynamics.residuals()[i].*level.residual << " " << level.unit << ", "
           << relative << " relative; the tolerance is " << tolerance_;
      throw FileError(text.str());
    }
  }
}

void LoopMotion::throwOpen(std::size_t row, ClosedLoopDynamics& dynamics) const {
  dynamics.compute(completed_);  // where the search ended
  const std::vector<ClosureResidual>& residuals = dynamics.relativeResiduals();
  const auto worst = std::max_element(
      residuals.begin(), residuals.end(),
      [](const auto& one, const auto& other) { return one.position < other.position; });
  if (worst->position <= tolerance_) {
    throw FileError(file_.at(row) +
                    ": the closures do not determine how the passive joints move: a singular "
                    "position; give the motion of all joints");
  }
  const auto closure = static_cast<std::size_t>(worst - residuals.begin());
  std::ostringstream text;
  text << file_.at(row) << ": the loops cannot be closed: closure '" << closures_[closure]
       << "' stays open by " << dynamics.residuals()[closure].position << " m or rad";
  throw FileError(text.str());
}

}  // namespace virtual_work_dynamics
