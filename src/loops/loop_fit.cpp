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
constexpr int kMostSteps = 10;
// Step, in standard deviations, that ends the search for positions.
constexpr double kLastStep = 1e-7;

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
}

LoopFit::LoopFit(const Mechanism& mechanism, const LoopKinematics& kinematics, double length,
                 double most)
    : kinematics_(kinematics),
      row_scales_(kinematics.conditions()),
      column_scales_(static_cast<Eigen::Index>(mechanism.coordinates().size())),
      most_(most) {
  for (const LoopGroup& group : loopGroups(mechanism, kinematics_)) {
    groups_.emplace_back(group, kinematics_);
  }
  for (Eigen::Index i = 0; i < row_scales_.size(); ++i) {
    row_scales_[i] = 1 / scaleOf(kinematics_.condition(i).unit, length);
  }
  for (Eigen::Index i = 0; i < column_scales_.size(); ++i) {
    column_scales_[i] = scaleOf(mechanism.unitOf(static_cast<int>(i)), length);
  }
  deviations_ = moved_ = step_ = column_scales_;
  residuals_ = row_scales_;
}

bool LoopFit::fit(Motion& motion, const MotionCovariance& covariance, bool rates) {
  farthest_ = Farthest();
  setDeviations(covariance, 0);
  const bool closes = fitPositions(motion.q);
  kinematics_.setPosition(motion.q);
  if (!closes || !rates) return closes;
  setDeviations(covariance, 1);
  kinematics_.setMotion(motion);
  if (!fitRates(motion.qd, kinematics_.rates())) return false;
  setDeviations(covariance, 2);
  kinematics_.setMotion(motion);
  return fitRates(motion.qdd, kinematics_.accelerations());
}

void LoopFit::setDeviations(const MotionCovariance& covariance, int level) {
  level_ = level;
  for (std::size_t i = 0; i < covariance.coordinates.size(); ++i) {
    const double variance = covariance.coordinates[i](level, level);
    deviations_[static_cast<Eigen::Index>(i)] = std::sqrt(std::max(variance, 0.0));
  }
}

// Entry of the Jacobian without units.
double LoopFit::entry(Eigen::Index condition, int coordinate) const {
  return row_scales_[condition] * kinematics_.jacobian()(condition, coordinate) *
         column_scales_[coordinate];
}

// Sets `found`, in standard deviations, to the least that meets the conditions of a group. Returns
// false where they cannot be compared.
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

bool LoopFit::isLikely(const Group& group) {
  bool likely = true;
  for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
    const double deviations = std::abs(group.found[static_cast<Eigen::Index>(k)]);
    likely = likely && deviations <= most_;
    if (!(deviations > farthest_.deviations)) continue;
    farthest_ = {deviations, group.coordinates[k], level_};
  }
  return likely;
}

// Each step is the least move from the measured position, not from where the step before ended, to
// where the conditions are met that are linear about the latter.
bool LoopFit::fitPositions(Eigen::VectorXd& q) {
  moved_.setZero();
  kinematics_.setPosition(q);
  bool likely = false;
  for (int steps = 0; steps < kMostSteps; ++steps) {
    residuals_.noalias() = kinematics_.jacobian() * moved_;
    residuals_ = kinematics_.phi() - residuals_;
    likely = true;
    double longest = 0;
    farthest_ = Farthest();
    step_ = moved_;
    for (Group& group : groups_) {
      if (!solve(group, residuals_, true)) return false;
      likely = isLikely(group) && likely;
      for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
        const int coordinate = group.coordinates[k];
        const double move = deviations_[coordinate] * group.found[static_cast<Eigen::Index>(k)];
        if (deviations_[coordinate] > 0) {
          longest =
              std::max(longest, std::abs(move - moved_[coordinate]) / deviations_[coordinate]);
        }
        step_[coordinate] = move;
      }
    }
    if (!likely) return false;
    moved_.swap(step_);
    step_ = q + moved_;
    kinematics_.setPosition(step_);
    if (longest <= kLastStep) break;
  }
  q += moved_;
  return true;
}

bool LoopFit::fitRates(Eigen::VectorXd& rates, const Eigen::VectorXd& residuals) {
  bool likely = true;
  for (Group& group : groups_) {
    likely = solve(group, residuals, false) && isLikely(group) && likely;
  }
  if (!likely) return false;
  for (const Group& group : groups_) {
    for (std::size_t k = 0; k < group.coordinates.size(); ++k) {
      const int coordinate = group.coordinates[k];
      rates[coordinate] += deviations_[coordinate] * group.found[static_cast<Eigen::Index>(k)];
    }
  }
  return true;
}

}  // namespace virtual_work_dynamics
