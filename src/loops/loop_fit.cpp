#include "loops/loop_fit.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

namespace {

// Rows whose entries are that small against those of conditions elsewhere are zero at this
// position: what they demand is met, or cannot be met.
constexpr double kAbsent = 1e-9;
// Part of a row, by standard deviations, that is left beside rows before it: less is rounding, or
// what redundant conditions disagree by.
constexpr double kRank = 1e-7;
constexpr int kMostFits = 10;
// Larger groups stay as they are measured, as the cost of a fit is cubic.
constexpr std::size_t kMostConditions = 100;
// Step, in standard deviations, or rad or over the length, that ends the search for positions.
constexpr double kLastStep = 1e-7, kFitRounding = 1e-14;
// Deviations of positions below which nothing is known of the noise, rad or over the length: a
// joint has not moved yet, or is simulated. Moves are judged by these then, of velocities
// relative to the largest.
constexpr double kUnknownNoise = 1e-9;
constexpr double kUnknownPosition = 1e-3, kUnknownVelocity = 1e-2;
// Deviations, without units, from which on a coordinate is no measurement, see FollowingMotors.
constexpr double kLoose = 1e5;
// Largest misfit of positions that are closed, rad or over the length.
constexpr double kClosed = 1e-9;

}  // namespace

LoopFit::Group::Group(const LoopGroup& loops, const LoopKinematics& kinematics)
    : coordinates(loops.coordinates), rows(0, 0) {
  for (const std::size_t set : loops.sets) {
    for (Eigen::Index i = kinematics.firstOf(set); i < kinematics.firstOf(set + 1); ++i) {
      conditions.push_back(i);
    }
  }
  const auto height = static_cast<Eigen::Index>(conditions.size());
  const auto width = static_cast<Eigen::Index>(coordinates.size());
  rows = RankFactorization(height, width);
  G.setZero(height, width);
  right.setZero(height);
  found.setZero(width);
  unknown.assign(coordinates.size(), false);
}

LoopFit::LoopFit(const Mechanism& mechanism, const LoopKinematics& kinematics, double length,
                 double tolerance)
    : kinematics_(kinematics),
      tolerance_(tolerance),
      row_scales_(kinematics.conditions()),
      column_scales_(static_cast<Eigen::Index>(mechanism.coordinates().size())) {
  for (const LoopGroup& group : loopGroups(mechanism, kinematics_)) {
    groups_.emplace_back(group, kinematics_);
    if (groups_.back().conditions.size() > kMostConditions) groups_.pop_back();
  }
  for (Eigen::Index i = 0; i < row_scales_.size(); ++i) {
    row_scales_[i] = 1 / scaleOf(kinematics_.condition(i).unit, length);
    rates_alone_ = rates_alone_ || !kinematics_.condition(i).has_position;
  }
  for (Eigen::Index i = 0; i < column_scales_.size(); ++i) {
    column_scales_[i] = scaleOf(mechanism.unitOf(static_cast<int>(i)), length);
  }
  deviations_ = moved_ = step_ = column_scales_;
  residuals_ = row_scales_;
}

bool LoopFit::fit(Motion& motion, const MotionCovariance* covariance, const Eigen::VectorXd& noise,
                  bool rates, double nearly) {
  farthest_ = Farthest();
  for (int level = 0; level < 2; ++level) {
    squares_[level] = 0;
    counted_[level] = 0;
  }
  setKnown(covariance);
  setDeviations(covariance, noise, 0);
  kinematics_.setPosition(motion.q);
  const bool closed = isNearlyClosed(nearly) && fitPositions(motion.q);
  kinematics_.setPosition(motion.q);
  if (closed && covariance) judge(0, 1);
  if (!rates) return closed;
  setDeviations(covariance, noise, 1);
  kinematics_.setMotion(motion);
  const double size = largest(motion.qd);
  fitRates(motion.qd, kinematics_.rates());
  if (covariance) judge(1, size);
  setDeviations(covariance, noise, 2);
  kinematics_.setMotion(motion);
  fitRates(motion.qdd, kinematics_.accelerations());
  return closed;
}

double LoopFit::rms(int level) const {
  const Eigen::Index count = counted_[level];
  return count == 0 ? 0 : std::sqrt(squares_[level] / static_cast<double>(count));
}

// What does not vary at all is exact. Of what hardly varies nothing is known.
void LoopFit::setKnown(const MotionCovariance* covariance) {
  for (Group& group : groups_) {
    group.known = covariance != nullptr;
    for (std::size_t k = 0; covariance && k < group.coordinates.size(); ++k) {
      const int i = group.coordinates[k];
      const Eigen::Matrix3d& own = covariance->coordinates[static_cast<std::size_t>(i)];
      const double least = kUnknownNoise * column_scales_[i];
      const bool positive = own(0, 0) > least * least && own(1, 1) > 0 && own(2, 2) > 0;
      group.unknown[k] = !positive && !own.isZero(0);
      group.known = group.known && !group.unknown[k];
    }
  }
}

void LoopFit::setDeviations(const MotionCovariance* covariance, const Eigen::VectorXd& noise,
                            int level) {
  deviations_ = column_scales_;
  if (!covariance) return;
  for (Eigen::Index i = 0; i < deviations_.size(); ++i) {
    const double variance = covariance->coordinates[static_cast<std::size_t>(i)](level, level);
    deviations_[i] = std::sqrt(std::max(variance, 0.0));
    if (level == 0 && variance > 0 && noise.size() > 0) {
      deviations_[i] = std::max(deviations_[i], noise[i]);
    }
  }
  weighUnknown();
}

// A coordinate of which nothing is known counts like the least known one beside it: as if it were
// exact, it would drag the others along.
void LoopFit::weighUnknown() {
  for (const Group& group : groups_) {
    if (group.known) continue;
    double most = 0;
    for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
      const int i = group.coordinates[k];
      if (!group.unknown[k] && deviations_[i] < kLoose * column_scales_[i]) {
        most = std::max(most, deviations_[i] / column_scales_[i]);
      }
    }
    if (most == 0) most = 1;
    for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
      const int i = group.coordinates[k];
      if (group.unknown[k]) deviations_[i] = most * column_scales_[i];
    }
  }
}

// Entry of the Jacobian without units.
double LoopFit::entry(Eigen::Index condition, int coordinate) const {
  return row_scales_[condition] * kinematics_.jacobian()(condition, coordinate) *
         column_scales_[coordinate];
}

// Sets `found`, in standard deviations, to the least that meets the conditions of a group. Returns
// false where that is no number.
bool LoopFit::solve(Group& group, const Eigen::VectorXd& residuals, bool positions) {
  for (std::size_t row = 0; row < group.conditions.size(); ++row) {
    const auto r = static_cast<Eigen::Index>(row);
    const Eigen::Index condition = group.conditions[row];
    double square = 0, weighted = 0;
    for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
      const int coordinate = group.coordinates[k];
      const double a = entry(condition, coordinate);
      const double w = a * deviations_[coordinate] / column_scales_[coordinate];
      group.G(r, static_cast<Eigen::Index>(k)) = w;
      square += a * a;
      weighted += w * w;
    }
    const bool counts = !(positions && !kinematics_.condition(condition).has_position) &&
                        square > kAbsent * kAbsent && weighted > 0;
    group.G.row(r) *= counts ? 1 / std::sqrt(weighted) : 0;
    group.right[r] =
        counts ? -row_scales_[condition] * residuals[condition] / std::sqrt(weighted) : 0;
  }
  if (!group.G.allFinite() || !group.right.allFinite()) return false;
  group.rows.factorize(group.G, kRank);
  group.rows.solve(group.right, group.found);
  return group.found.allFinite();
}

// Conditions without a position have zeros.
bool LoopFit::isNearlyClosed(double nearly) const {
  for (const Group& group : groups_) {
    for (const Eigen::Index i : group.conditions) {
      if (!(std::abs(row_scales_[i] * kinematics_.phi()[i]) <= nearly)) return false;
    }
  }
  return true;
}

// Each step is the least move from the measured position, not from where the step before ended, to
// where the conditions are met that are linear about the latter.
bool LoopFit::fitPositions(Eigen::VectorXd& q) {
  moved_.setZero();
  for (int steps = 0; steps < kMostFits; ++steps) {
    residuals_.noalias() = kinematics_.jacobian() * moved_;
    residuals_ = kinematics_.phi() - residuals_;
    bool arrived = true;
    for (Group& group : groups_) {
      if (!solve(group, residuals_, true)) return false;
      for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
        const int coordinate = group.coordinates[k];
        if (deviations_[coordinate] == 0) continue;
        const double move = deviations_[coordinate] * group.found[static_cast<Eigen::Index>(k)];
        const double last = std::max(kLastStep * deviations_[coordinate],
                                     kFitRounding * column_scales_[coordinate]);
        arrived = arrived && std::abs(move - moved_[coordinate]) <= last;
        moved_[coordinate] = move;
      }
    }
    step_ = q + moved_;
    kinematics_.setPosition(step_);
    if (!arrived) continue;
    if (!isNearlyClosed(kClosed)) return false;
    q = step_;
    return true;
  }
  return false;
}

void LoopFit::fitRates(Eigen::VectorXd& rates, const Eigen::VectorXd& residuals) {
  for (Group& group : groups_) {
    if (!solve(group, residuals, false)) {
      group.found.setZero();
      continue;
    }
    for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
      const int coordinate = group.coordinates[k];
      rates[coordinate] += deviations_[coordinate] * group.found[static_cast<Eigen::Index>(k)];
    }
  }
}

double LoopFit::largest(const Eigen::VectorXd& rates) const {
  double most = 0;
  for (const Group& group : groups_) {
    for (const int i : group.coordinates) {
      most = std::max(most, std::abs(rates[i]) / column_scales_[i]);
    }
  }
  return most;
}

// Takes note of the moves of a level. @param size 1, or the largest velocity
void LoopFit::judge(int level, double size) {
  for (const Group& group : groups_) {
    const double least =
        group.known ? 0 : size * (level == 0 ? kUnknownPosition : kUnknownVelocity);
    for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
      const int i = group.coordinates[k];
      const double move = std::abs(deviations_[i] * group.found[static_cast<Eigen::Index>(k)]);
      if (move <= tolerance_ * column_scales_[i] * size) continue;
      const double deviations = move / std::max(deviations_[i], least * column_scales_[i]);
      squares_[level] += deviations * deviations;
      if (deviations > farthest_.deviations) farthest_ = {deviations, i, level, move};
    }
    counted_[level] += group.rows.rank();
  }
}

}  // namespace virtual_work_dynamics
