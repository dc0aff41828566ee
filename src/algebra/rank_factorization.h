#pragma once

#include <Eigen/Core>
#include <vector>

namespace virtual_work_dynamics {

/// Rank-revealing orthogonal factorisation of G for the system G x = b, all of its solutions, and
/// what of x they agree on. Householder's QR with column pivoting of the transpose: the rows of G
/// that are independent, an orthonormal basis of their space, and one of the null space. The caller
/// scales G so that its entries can be compared. Nothing after construction allocates.
class RankFactorization {
 public:
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  /// For matrices of up to that many rows and columns.
  RankFactorization(Eigen::Index most_rows, Eigen::Index most_columns);

  /// Rows count for the rank when what the rows before leave of them is longer than `relative`
  /// times the longest row of G and than `absolute`.
  void factorize(const Matrix& G, double relative, double absolute = 0);

  Eigen::Index rows() const { return rows_; }
  Eigen::Index columns() const { return columns_; }
  Eigen::Index rank() const { return rank_; }
  /// Dimension of the null space.
  Eigen::Index redundancy() const { return columns_ - rank_; }

  /// Of the triangle's diagonal: the last counted entry over the first uncounted one; infinite when
  /// that is zero or there is none.
  double gap() const;
  /// The first over the last counted entry, a lower bound of the condition number; 1 for rank 0.
  double condition() const;

  /// The solution of least norm of the independent rows; the others follow if b is consistent.
  void solve(const Vector& b, Eigen::Ref<Eigen::VectorXd> x) const;

  /// Orthonormal columns that span the space of the rows, rank() of them, and the null space,
  /// redundancy() of them.
  auto rowSpace() const { return Q_.topLeftCorner(columns_, rank_); }
  auto nullSpace() const { return Q_.block(0, rank_, columns_, redundancy()); }

 private:
  void reflect(Eigen::Index step);
  void accumulate();
  Eigen::Index steps() const { return rows_ < columns_ ? rows_ : columns_; }

  Eigen::Index rows_ = 0, columns_ = 0, rank_ = 0;
  Eigen::MatrixXd R_;  // columns x rows: Householder vectors below, the triangle above
  Eigen::MatrixXd Q_;  // columns x columns
  Eigen::VectorXd factors_;
  std::vector<Eigen::Index> pivots_;
  mutable Eigen::VectorXd work_;
};

}  // namespace virtual_work_dynamics
