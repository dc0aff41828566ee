#pragma once

#include <Eigen/Core>

#include "algebra/rank_factorization.h"

namespace virtual_work_dynamics {

/// Chooses one of the solutions x + N y of an underdetermined system by one least-squares criterion
/// after the other, each among the solutions that are equally good by the earlier ones. Allocates
/// in its constructor only.
class LeastNorms {
 public:
  /// @param unknowns length of x.   @param most_costs largest number of rows for reduce().
  LeastNorms(Eigen::Index unknowns, Eigen::Index most_costs);

  /// Begins with the open directions that the orthonormal columns of `basis` span.
  void start(const Eigen::Ref<const Eigen::MatrixXd>& basis);

  /// Number of directions in which x is still open.
  Eigen::Index open() const { return open_; }
  /// The open directions: unknowns x open(), with orthonormal columns.
  auto space() const { return space_.leftCols(open_); }

  /// The linear costs of each column of space(), rows x open(); to be filled before reduce().
  auto costs(Eigen::Index rows) { return costs_.topLeftCorner(rows, open_); }
  /// The linear costs of x, one for each row; to be filled before reduce().
  auto costOfSolution(Eigen::Index rows) { return now_.head(rows); }
  /// Moves x to where the sum of squares of its costs is least, and keeps those directions open
  /// that do not change the costs. Costs of unit vectors below 1e-10 count as zero.
  /// @returns by how much open() shrinks.
  Eigen::Index reduce(Eigen::Index rows, Eigen::VectorXd& x);

  /// Moves x along the open directions to where its own norm is least.
  void finish(Eigen::VectorXd& x);

 private:
  Eigen::Index open_ = 0;
  Eigen::MatrixXd space_, next_space_, costs_, costs_transposed_;
  Eigen::VectorXd now_, along_, chosen_;
  RankFactorization by_rows_, by_columns_;
};

}  // namespace virtual_work_dynamics
