#pragma once

#include <Eigen/Core>
#include <vector>

#include "algebra/multifrontal_qr.h"
#include "algebra/rank_factorization.h"

namespace virtual_work_dynamics {

/// The one decision about ranks in closed loops, for assembly, completion and forces alike. A row
/// of conditions or unknowns counts when the rows before leave of it more than the rank's tolerance
/// times its size, see ConditionSizes; a row of unknown size has the length of its entries. One
/// factorisation M = D Q R, where D holds the sizes, tells everything that depends on the rank:
/// free motions M u = 0, what a load M^T x = load needs, and the changes M^T x = 0. Allocates in
/// its constructor only.
class LoopRank {
 public:
  using Vector = RankFactorization::Vector;

  /// @param sizes by row of the matrices to come; zero where it is not known
  LoopRank(Eigen::VectorXd sizes, Eigen::Index most_columns, double tolerance);

  /// Size of the largest row, or of its entries where they tell it.
  double largestSize() const { return largest_; }

  /// Decides for the columns of `of` that `present` marks.
  void decide(const MultifrontalQr& of, const std::vector<bool>& present);

  Eigen::Index rank() const { return factorization_.rank(); }
  /// Number of columns that were present.
  Eigen::Index columns() const { return factorization_.columns(); }
  /// Dimension of the changes M^T x = 0.
  Eigen::Index changes() const { return factorization_.rows() - rank(); }
  double gap() const { return factorization_.gap(); }
  /// Size of rows over what is left of the last one that counts; 1 for rank 0.
  double condition() const;

  /// Orthonormal columns that span the motions M u = 0, by column that was present.
  auto freeMotions() const { return factorization_.nullSpace(); }
  /// Solves M u = right for the rows that count, with the least u; `u` is by column of the matrix,
  /// zero where absent.
  void solve(const Vector& right, Eigen::Ref<Eigen::VectorXd> u);
  /// Sets orthonormal columns, changes() of them.
  void getChanges(Eigen::Ref<Eigen::MatrixXd> changes) const;
  /// Solves M^T x = load, where the load has no part along a free motion. Rows that do not count
  /// get nothing.
  void solveLoad(const Vector& load, Eigen::Ref<Eigen::VectorXd> x) const;

 private:
  Eigen::VectorXd sizes_;  // as given
  double largest_;
  Eigen::VectorXd used_;     // sizes of the present matrix
  Eigen::MatrixXd scaled_;   // its present columns, rows divided by their sizes
  std::vector<int> places_;  // by column; -1 where absent
  RankFactorization factorization_;
  double tolerance_;
  Eigen::VectorXd right_, packed_;
};

}  // namespace virtual_work_dynamics
