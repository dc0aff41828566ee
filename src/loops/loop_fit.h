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
  /// @param most deviations that a coordinate may be moved by
  LoopFit(const Mechanism& mechanism, const LoopKinematics& kinematics, double length, double most);

  /// Positions, then velocities and accelerations if `rates`. Returns false at the first level at
  /// which a coordinate would have to be moved further; it and those after it stay.
  bool fit(Motion& motion, const MotionCovariance& covariance, bool rates);
  /// What was, or would have been, moved the most by the latest fit().
  struct Farthest {
    double deviations = 0;
    int coordinate = -1, level = 0;
  };
  const Farthest& farthest() const { return farthest_; }

 private:
  struct Group {
    Group(const LoopGroup& loops, const LoopKinematics& kinematics);
    std::vector<int> coordinates;
    std::vector<Eigen::Index> conditions;
    RankFactorization rows;
    Eigen::MatrixXd G;  // conditions x coordinates, by standard deviations; rows of length 1
    Eigen::VectorXd right, found;
  };
  double entry(Eigen::Index condition, int coordinate) const;
  bool solve(Group& group, const Eigen::VectorXd& residuals, bool positions);
  bool fitPositions(Eigen::VectorXd& q);
  bool fitRates(Eigen::VectorXd& rates, const Eigen::VectorXd& residuals);
  void setDeviations(const MotionCovariance& covariance, int level);
  bool isLikely(const Group& group);

  LoopKinematics kinematics_;
  std::vector<Group> groups_;
  Eigen::VectorXd row_scales_;     // by condition: 1, or one over the length
  Eigen::VectorXd column_scales_;  // by coordinate: 1, or the length
  Eigen::VectorXd deviations_;     // by coordinate, of the level at hand
  int level_ = 0;
  Eigen::VectorXd step_, moved_, residuals_;  // by coordinate, by coordinate, by condition
  double most_;
  Farthest farthest_;
};

}  // namespace virtual_work_dynamics
