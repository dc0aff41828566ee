#include "offline/loop_motion.h"

#include <algorithm>
#include <iostream>
#include <sstream>

#include "base/number_text.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

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
      completed_(dynamics.coordinates()),
      follower_(mechanism, dynamics) {
  const Names& all = mechanism.coordinateNames();
  const Names& joints = file_.table.joints;
  for (const std::string& name : joints) {
    coordinates_.push_back(std::find(all.begin(), all.end(), name) - all.begin());
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
}

void LoopMotion::take(std::size_t row, Motion& motion) const {
  const MotionTable& table = file_.table;
  const auto index = static_cast<Eigen::Index>(row);
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    motion.q[coordinates_[i]] = table.positions(index, column);
    motion.qd[coordinates_[i]] = table.velocities(index, column);
    motion.qdd[coordinates_[i]] = table.accelerations(index, column);
  }
}

void LoopMotion::complete(std::size_t row, ClosedLoopDynamics& dynamics, Motion& motion) {
  take(row, motion);
  if (!completes()) return;
  completed_ = motion;
  const bool closes =
      positions_follow_ ? follower_.complete(completed_, dynamics) : dynamics.complete(completed_);
  if (!closes) throwOpen(row, dynamics);
  if (positions_follow_) motion.q = completed_.q;
  if (velocities_follow_) motion.qd = completed_.qd;
  if (accelerations_follow_) motion.qdd = completed_.qdd;
}

void LoopMotion::check(std::size_t row, const LoopSample& computed) const {
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    for (const Level& level : kLevels) {
      const double relative = computed.relativeResiduals()[i].*level.residual;
      if (relative <= tolerance_) continue;
      std::ostringstream text;
      text << file_.at(row) << ": the " << level.name << " violate closure '" << closures_[i]
           << "' by " << computed.residuals()[i].*level.residual << " " << level.unit << ", "
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
