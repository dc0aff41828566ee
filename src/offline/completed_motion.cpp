#include "offline/completed_motion.h"

#include <algorithm>
#include <iostream>
#include <sstream>
#include <utility>
#include <vector>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "dynamics/given_joints.h"
#include "dynamics/sample_rows.h"
#include "offline/arguments.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

std::string joined(const Names& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool rests(const RecordingOptions& options, const std::string& name) {
  return std::any_of(options.rest.begin(), options.rest.end(),
                     [&](const auto& joint) { return joint.first == name; });
}

void checkRest(const Mechanism& mechanism, const RecordingOptions& options) {
  for (const auto& [name, position] : options.rest) {
    if (contains(mechanism.coordinateNames(), name)) continue;
    throw UsageError("--rest: robot " + inQuotes(mechanism.name()) + " has no joint " +
                     inQuotes(name) + " that moves by itself" +
                     nameHelp(name, mechanism.coordinateNames()));
  }
}

// Chooses all coordinates, or the actuated ones when no passive joint is given; joints that rest
// may be missing.
JointChoice choiceOf(const std::string& path, const Mechanism& mechanism, const Dynamics& dynamics,
                     const RecordingOptions& options) {
  checkRest(mechanism, options);
  return [&path, &mechanism, &dynamics, &options](const Names& header) {
    const Names& all = mechanism.coordinateNames();
    const GivenJoints rule(mechanism, dynamics);
    // The file's reader names missing actuated joints.
    std::vector<bool> given = dynamics.actuated();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (contains(header, all[i]) || rests(options, all[i])) given[i] = true;
    }
    if (const auto problem = rule.problem(given)) throw FileError(path + ": " + *problem);
    Names wanted;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool missing = rests(options, all[i]) && !contains(header, all[i]);
      if (given[i] && !missing) wanted.push_back(all[i]);
    }
    return wanted;
  };
}

// Widens the covariances, like the table.
void widenCovariances(const Names& all, MotionTable& table) {
  const std::vector<Eigen::Matrix3d> given = std::move(table.covariances);
  table.covariances.assign(table.times.size() * all.size(), Eigen::Matrix3d::Zero());
  for (std::size_t row = 0; row < table.times.size(); ++row) {
    for (std::size_t i = 0; i < table.joints.size(); ++i) {
      const auto place = std::find(all.begin(), all.end(), table.joints[i]) - all.begin();
      table.covariances[row * all.size() + static_cast<std::size_t>(place)] =
          given[row * table.joints.size() + i];
    }
  }
}

// Widens the table to columns of all coordinates; new columns are zero.
void widen(const Mechanism& mechanism, MotionTable& table) {
  const Names& all = mechanism.coordinateNames();
  if (table.hasCovariances()) widenCovariances(all, table);
  for (Eigen::MatrixXd* columns : {&table.positions, &table.velocities, &table.accelerations}) {
    const Eigen::MatrixXd given = *columns;
    columns->setZero(static_cast<Eigen::Index>(table.times.size()),
                     static_cast<Eigen::Index>(all.size()));
    for (std::size_t i = 0; i < table.joints.size(); ++i) {
      const auto place = std::find(all.begin(), all.end(), table.joints[i]) - all.begin();
      columns->col(place) = given.col(static_cast<Eigen::Index>(i));
    }
  }
  table.joints = all;
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

CompletedMotion::CompletedMotion(const std::string& path, const Mechanism& mechanism,
                                 const Scene& scene, const Dynamics& dynamics, double tolerance,
                                 const RecordingOptions& options)
    : closures_(dynamics.closureNames()),
      tolerance_(tolerance),
      file_(readMotion(path, mechanism, choiceOf(path, mechanism, dynamics, options))),
      row_(dynamics.coordinates()),
      passive_(mechanism, dynamics) {
  const Names wrapped = unwrapPositions(mechanism, file_.table);
  if (!wrapped.empty()) {
    std::cerr << "note: " << printable(path)
              << ": whole turns that a driver left out are added to the positions of "
              << joined(wrapped) << "\n";
  }
  std::vector<std::pair<std::string, double>> resting;
  for (const auto& joint : options.rest) {
    if (!contains(file_.table.joints, joint.first)) resting.push_back(joint);
  }
  positions_follow_ =
      file_.table.joints.size() + resting.size() < mechanism.coordinateNames().size();
  if (dynamics.closuresDetermine() && !scene.static_motion) {
    velocities_follow_ = positions_follow_ || !file_.table.hasVelocities();
    accelerations_follow_ = positions_follow_ || !file_.table.hasAccelerations();
  }
  CompletionSettings completion = options.completion;
  completion.keep_positions = dynamics.closed();
  completeDerivatives(mechanism, scene, completion, file_);
  if (positions_follow_ || !resting.empty()) widen(mechanism, file_.table);
  for (const auto& [name, position] : resting) {
    const Names& all = file_.table.joints;
    const auto place = std::find(all.begin(), all.end(), name) - all.begin();
    file_.table.positions.col(place).setConstant(position);
  }
  Names follow;
  if (positions_follow_) follow.push_back("positions");
  if (velocities_follow_) follow.push_back("velocities");
  if (accelerations_follow_) follow.push_back("accelerations");
  if (!follow.empty()) {
    std::cerr << "note: " << printable(path)
              << ": of passive joints, computed from the closures: " << joined(follow) << "\n";
  }
}

void CompletedMotion::complete(std::size_t row, const Dynamics& dynamics,
                               Dynamics::Workspace& workspace) {
  if (!completes()) return;
  MotionTable& table = file_.table;
  takeRow(table, row, row_);
  const bool closes = positions_follow_ ? passive_.complete(row_, dynamics, workspace)
                                        : dynamics.complete(row_, workspace);
  if (!closes) throw FileError(file_.at(row) + ": " + dynamics.whyOpen(row_, workspace));
  const auto index = static_cast<Eigen::Index>(row);
  if (positions_follow_) table.positions.row(index) = row_.q;
  if (velocities_follow_) table.velocities.row(index) = row_.qd;
  if (accelerations_follow_) table.accelerations.row(index) = row_.qdd;
}

void CompletedMotion::check(std::size_t row, const Results& computed) const {
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    for (const Level& level : kLevels) {
      const double relative = computed.loops.relative_residuals[i].*level.residual;
      if (relative <= tolerance_) continue;
      std::ostringstream text;
      text << file_.at(row) << ": the " << level.name << " violate closure "
           << inQuotes(closures_[i]) << " by " << computed.loops.residuals[i].*level.residual << " "
           << level.unit << ", " << relative << " relative; the tolerance is " << tolerance_;
      throw FileError(text.str());
    }
  }
}

}  // namespace virtual_work_dynamics
