#include "offline/completed_motion.h"

#include <iostream>
#include <sstream>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "dynamics/given_joints.h"
#include "motion/table_row.h"
#include "offline/free_turn_rows.h"
#include "offline/root_rows.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

// Widens the covariances, like the table.
void widenCovariances(const Mechanism& mechanism, MotionTable& table) {
  const Names& all = mechanism.coordinateNames();
  const std::vector<Eigen::Matrix3d> given = std::move(table.covariances);
  table.covariances.assign(table.times.size() * all.size(), Eigen::Matrix3d::Zero());
  for (std::size_t row = 0; row < table.times.size(); ++row) {
    for (std::size_t i = 0; i < table.joints.size(); ++i) {
      const int place = mechanism.coordinateIndex(table.joints[i]);
      table.covariances[row * all.size() + static_cast<std::size_t>(place)] =
          given[row * table.joints.size() + i];
    }
  }
}

// Widens the table to columns of all coordinates; new columns are zero.
void widen(const Mechanism& mechanism, MotionTable& table) {
  const Names& all = mechanism.coordinateNames();
  if (table.hasCovariances()) widenCovariances(mechanism, table);
  for (Eigen::MatrixXd* columns : {&table.positions, &table.velocities, &table.accelerations}) {
    const Eigen::MatrixXd given = *columns;
    columns->setZero(static_cast<Eigen::Index>(table.times.size()),
                     static_cast<Eigen::Index>(all.size()));
    for (std::size_t i = 0; i < table.joints.size(); ++i) {
      const int place = mechanism.coordinateIndex(table.joints[i]);
      columns->col(place) = given.col(static_cast<Eigen::Index>(i));
    }
  }
  table.joints = all;
}

// Takes the last columns off a table that has velocities and accelerations.
MotionTable takenFrom(MotionTable& table, std::size_t count) {
  MotionTable taken;
  if (count == 0) return taken;
  const auto columns = static_cast<Eigen::Index>(count);
  const std::size_t kept = table.joints.size() - count;
  const auto take = [&](Eigen::MatrixXd& from, Eigen::MatrixXd& to) {
    to = from.rightCols(columns);
    from = from.leftCols(from.cols() - columns).eval();
  };
  take(table.positions, taken.positions);
  take(table.velocities, taken.velocities);
  take(table.accelerations, taken.accelerations);
  taken.joints.assign(table.joints.begin() + static_cast<std::ptrdiff_t>(kept), table.joints.end());
  table.joints.resize(kept);
  table.covariances.clear();
  return taken;
}

Names notGiven(const Mechanism& mechanism, const Given& given) {
  Names names;
  for (std::size_t i = 0; i < given.coordinates.size(); ++i) {
    if (!given.coordinates[i]) names.push_back(mechanism.coordinateNames()[i]);
  }
  return names;
}

struct Level {
  const char* name;
  const char* unit;
  double ClosureResidual::*residual;
};

// Rows from which the noise of a recording can be told.
constexpr std::size_t kFewestKnown = 16;
// Less than any that is known.
constexpr double kUnknownVariance = 1e-24;

constexpr Level kLevels[] = {{"positions", "m or rad", &ClosureResidual::position},
                             {"velocities", "m/s or rad/s", &ClosureResidual::velocity},
                             {"accelerations", "m/s^2 or rad/s^2", &ClosureResidual::acceleration}};

}  // namespace

CompletedMotion::CompletedMotion(RecordedMotion recorded, const Mechanism& mechanism,
                                 const Scene& scene, const Dynamics& dynamics, double tolerance,
                                 const RecordingOptions& options)
    : tolerance_(tolerance),
      file_(std::move(recorded.file)),
      row_(dynamics.coordinates(), dynamics.orientations()),
      driven_row_(static_cast<Eigen::Index>(recorded.given.drivenNumbers())),
      passive_(mechanism, dynamics, recorded.given) {
  for (std::size_t i = 0; i < dynamics.closureNames().size(); ++i) {
    closures_.push_back(dynamics.closureLabel(i));
  }
  positions_follow_ = !GivenJoints::givesAll(recorded.given);
  const bool estimates = !file_.table.hasAccelerations();
  if (!positions_follow_ && estimates && recorded.drives.empty() && !scene.static_motion) {
    fit_.emplace(mechanism, dynamics, tolerance);
    if (!fit_->any()) fit_.reset();
  }
  if (!fit_ && (dynamics.closuresDetermine() || positions_follow_) && !scene.static_motion) {
    velocities_follow_ = positions_follow_ || !file_.table.hasVelocities();
    accelerations_follow_ = positions_follow_ || !file_.table.hasAccelerations();
  }
  CompletionSettings completion = options.completion;
  completion.keep_positions = dynamics.closed() && !fit_;
  if (fit_) completion.covariances = true;
  completion.other_columns = recorded.drivenColumns() > 0;
  completeDerivatives(mechanism, scene, completion, file_);
  if (fit_) setNoise(mechanism);
  completeRoots(mechanism, scene, completion, file_);
  driven_ = takenFrom(file_.table, recorded.drivenColumns());
  const DrivenRows& drives = recorded.drives;
  drives.insertClosures(static_cast<Eigen::Index>(recorded.closureColumns()), driven_);
  if (positions_follow_ || !recorded.resting.empty() || !drives.empty() || recorded.motors.any() ||
      dynamics.orientations() > 0) {
    widen(mechanism, file_.table);
  }
  drives.setCoordinates(file_.table);
  completeFreeTurns(mechanism, scene, completion, file_);
  for (const auto& [name, position] : recorded.resting) {
    file_.table.positions.col(mechanism.coordinateIndex(name)).setConstant(position);
  }
  if (recorded.motors.any()) {
    recorded.motors.set(file_.table);
    motors_ = recorded.motors;
    std::cerr << "note: " << printable(file_.path) << ": of " << joined(recorded.motors.names())
              << ", computed from the joints that they move: positions, velocities, "
                 "accelerations\n";
  }
  Names follow;
  if (positions_follow_) follow.push_back("positions");
  if (velocities_follow_) follow.push_back("velocities");
  if (accelerations_follow_) follow.push_back("accelerations");
  if (!follow.empty()) {
    const bool all = !positions_follow_ || (recorded.given.drivenNumbers() == 0 &&
                                            recorded.given.coordinates == dynamics.actuated());
    std::cerr << "note: " << printable(file_.path) << ": of "
              << (all ? "passive joints" : joined(notGiven(mechanism, recorded.given)))
              << ", computed from the closures: " << joined(follow) << "\n";
  }
}

void CompletedMotion::complete(std::size_t row, const Dynamics& dynamics,
                               Dynamics::Workspace& workspace) {
  if (!completes()) return;
  if (fit_) return fit(row);
  MotionTable& table = file_.table;
  takeRow(table, row, row_);
  takeRow(driven_, row, driven_row_);
  const bool closes = positions_follow_ ? passive_.complete(row_, driven_row_, dynamics, workspace)
                                        : dynamics.complete(row_, workspace);
  if (!closes) {
    throw FileError(file_.at(row) + ": " +
                    (positions_follow_ ? passive_.whyOpen(dynamics, workspace)
                                       : dynamics.whyOpen(row_, workspace)));
  }
  const auto index = static_cast<Eigen::Index>(row);
  if (positions_follow_) table.positions.row(index) = row_.q;
  for (std::size_t i = 0; i < row_.orientations.size(); ++i) {
    table.orientations.row(index).segment<4>(static_cast<Eigen::Index>(4 * i)) =
        row_.orientations[i].coeffs();
  }
  if (velocities_follow_) table.velocities.row(index) = row_.qd;
  if (accelerations_follow_) table.accelerations.row(index) = row_.qdd;
}

void CompletedMotion::setNoise(const Mechanism& mechanism) {
  noise_.setZero(row_.q.size());
  for (std::size_t i = 0; i < file_.noises.size(); ++i) {
    const int coordinate = mechanism.coordinateIndex(file_.table.joints[i]);
    noise_[coordinate] = file_.noises[i];
    measured_.push_back(static_cast<std::size_t>(coordinate));
  }
}

void CompletedMotion::fit(std::size_t row) {
  MotionTable& table = file_.table;
  takeRow(table, row, row_);
  const std::size_t count = table.joints.size();
  const auto first = table.covariances.begin() + static_cast<std::ptrdiff_t>(row * count);
  covariance_.coordinates.assign(first, first + static_cast<std::ptrdiff_t>(count));
  // The noise of a joint that does not move is not known, but it is not exact.
  for (const std::size_t i : measured_) {
    Eigen::Matrix3d& own = covariance_.coordinates[i];
    if (own.isZero(0)) own = kUnknownVariance * Eigen::Matrix3d::Identity();
  }
  motors_.loosen(covariance_);
  const bool known = table.times.size() >= kFewestKnown;
  fitted_.add(fit_->fit(row_, known ? &covariance_ : nullptr, noise_));
  motors_.set(row_);
  const auto index = static_cast<Eigen::Index>(row);
  table.positions.row(index) = row_.q;
  table.velocities.row(index) = row_.qd;
  table.accelerations.row(index) = row_.qdd;
}

std::string CompletedMotion::fitNote(const Mechanism& mechanism) const {
  if (fitted_.fitted == 0) return "";
  return (fitted_.doubtful() ? "warning: " : "note: ") + printable(file_.path) + ": " +
         fitted_.text(mechanism, "row", "rows") + "\n";
}

void CompletedMotion::check(std::size_t row, const Results& computed) const {
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    for (const Level& level : kLevels) {
      const double relative = computed.loops.relative_residuals[i].*level.residual;
      if (relative <= tolerance_) continue;
      // Rates that are estimated may miss near singular positions.
      if (fit_ && level.residual != &ClosureResidual::position) continue;
      std::ostringstream text;
      text << file_.at(row) << ": the " << level.name << " violate " << closures_[i] << " by "
           << computed.loops.residuals[i].*level.residual << " " << level.unit << ", " << relative
           << " relative; the tolerance is " << tolerance_;
      if (fit_) text << "; it is too much to be fitted: zeros of encoders or dimensions are wrong";
      throw FileError(text.str());
    }
  }
}

}  // namespace virtual_work_dynamics
