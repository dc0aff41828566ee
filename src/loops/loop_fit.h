#pragma once

#include <Eigen/Core>
#include <vector>

#include "algebra/rank_factorization.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"

namespace virtual_work_dynamics {

/// Moves measured coordinates to where the conditions of the loops are met, each by as few of its
/// standard deviations as can be: the x of least norm with A S x = -(residual), S the standard
/// deviations, which for normal errors is the most likely motion. Positions by the Gauss-Newton
/// method, then velocities and accelerations, each level by itself. The cost grows with the cube of
/// the conditions that share coordinates. Nothing after construction allocates.
class LoopFit {
 public:
  /// @param kinematics conditions that are at the assembly; copied
  /// @param length makes lengths comparable with angles, m
  /// @param tolerance of moves that need no explanation, see MotionFit
  LoopFit(const Mechanism& mechanism, const LoopKinematics& kinematics, double length,
          double tolerance);

  /// Whether there are conditions on rates alone.
  bool hasRatesAlone() const { return rates_alone_; }

  /// Fits a motion, see MotionFit::fit(). Returns false where the positions leave the conditions
  /// open by more than `nearly`, rad or over the length, or cannot be closed; they then stay.
  bool fit(Motion& motion, const MotionCovariance* covariance, const Eigen::VectorXd& noise,
           bool rates, double nearly);

  /// The move of a position or velocity that is the largest in deviations.
  struct Farthest {
    double deviations = 0;
    int coordinate = -1, level = 0;
    double amount = 0;  ///< rad or m, per s
  };
  const Farthest& farthest() const { return farthest_; }
  /// Root of the mean square of the moves of a level, 0 or 1, in deviations, for each condition
  /// that counts.
  double rms(int level) const;

 private:
  struct Group {
    Group(const LoopGroup& loops, const LoopKinematics& kinematics);
    std::vector<int> coordinates;
    std::vector<Eigen::Index> conditions;
    RankFactorization rows;
    Eigen::MatrixXd G;  // conditions x coordinates, by standard deviations; rows of length 1
    Eigen::VectorXd right, found;
    std::vector<bool> unknown;  // coordinates of which the noise is not known
    bool known = true;          // whether that of all is known
  };
  void setKnown(const MotionCovariance* covariance);
  void weighUnknown();
  void setDeviations(const MotionCovariance* covariance, const Eigen::VectorXd& noise, int level);
  double entry(Eigen::Index condition, int coordinate) const;
  bool solve(Group& group, const Eigen::VectorXd& residuals, bool positions);
  bool isNearlyClosed(double nearly) const;
  bool fitPositions(Eigen::VectorXd& q);
  void fitRates(Eigen::VectorXd& rates, const Eigen::VectorXd& residuals);
  double largest(const Eigen::VectorXd& rates) const;
  void judge(int level, double size);

  LoopKinematics kinematics_;
  std::vector<Group> groups_;
  double tolerance_;
  bool rates_alone_ = false;
  Eigen::VectorXd row_scales_;                // by condition: 1, or one over the length
  Eigen::VectorXd column_scales_;             // by coordinate: 1, or the length
  Eigen::VectorXd deviations_;                // by coordinate, of the level at hand
  Eigen::VectorXd step_, moved_, residuals_;  // by coordinate, by coordinate, by condition
  Farthest farthest_;
  // By level: sums of squares of moves in deviations, and the conditions that these were for.
  double squares_[2] = {0, 0};
  Eigen::Index counted_[2] = {0, 0};
};

}  // namespace virtual_work_dynamics
