#pragma once

#include <Eigen/Core>

#include "algebra/rank_factorization.h"

namespace virtual_work_dynamics {

/// Chooses one of the solutions x + N y of an underdetermined system by one least-squares wish
/// after the other, each among the solutions that meet the earlier ones equally well. Nothing after
/// construction allocates.
class LeastNorms {
 public:
  LeastNorms(Eigen::Index unknowns, Eigen::Index most_costs);

  /// The orthonormal columns of `basis` span what is open.
  void start(const Eigen::Ref<const Eigen::MatrixXd>& basis);

  /// Of dimension open(); its columns stay orthonormal.
  Eigen::Index open() const { return open_; }
  auto space() const { return space_.leftCols(open_); }

  /// To be filled before reduce(): a linear cost of each column of space(), and of x.
  auto costs(Eigen::Index rows) { return costs_.topLeftCorner(rows, open_); }
  auto costOfSolution(Eigen::Index rows) { return now_.head(rows); }
  /// Moves x to where the sum of squares of its costs is least, and keeps open what does not change
  /// them. Costs of unit vectors below 1e-10 are zero. Returns by how much open() shrinks.
  Eigen::Index reduce(Eigen::Index rows, Eigen::VectorXd& x);

  /// Moves x to its own least norm.
  void finish(Eigen::VectorXd& x);

 private:
  Eigen::Index open_ = 0;
  Eigen::MatrixXd space_, next_space_, costs_, costs_transposed_;
  Eigen::VectorXd now_, along_, chosen_;
  RankFactorization by_rows_, by_columns_;
};

}  // namespace virtual_work_dynamics
