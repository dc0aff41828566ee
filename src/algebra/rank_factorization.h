#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace virtual_work_dynamics {

/// Rank-revealing orthogonal factorisation of G for the system G x = b: it tells all solutions, and
/// which part of x they agree on. It is Householder's QR with column pivoting of the transpose,
/// which finds the independent rows of G, an orthonormal basis of the space they span, and one of
/// the null space. The caller scales G so that its entries can be compared. Allocates in its
/// constructor only.
class RankFactorization {
 public:
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  /// Makes room for matrices of up to that many rows and columns.
  RankFactorization(Eigen::Index most_rows, Eigen::Index most_columns);

  /// Factorizes G. A row counts for the rank when its part that is orthogonal to the rows before it
  /// is longer than `relative` times the longest row of G and longer than `absolute`.
  void factorize(const Matrix& G, double relative, double absolute = 0);

  Eigen::Index rows() const { return rows_; }
  Eigen::Index columns() const { return columns_; }
  Eigen::Index rank() const { return rank_; }
  /// Dimension of the null space.
  Eigen::Index redundancy() const { return columns_ - rank_; }

  /// The last entry of the triangle's diagonal that counts for the rank over the first that does
  /// not; infinite when the latter is zero or does not exist.
  double gap() const;
  /// The first entry of the triangle's diagonal over the last that counts for the rank, a lower
  /// bound of the condition number; 1 for rank 0.
  double condition() const;
  /// The first of these entries, and the last; the rank must not be 0.
  double largest() const { return std::abs(R_(0, 0)); }
  double least() const { return std::abs(R_(rank_ - 1, rank_ - 1)); }

  /// Solves the independent rows for the x of least norm; the other rows then hold too if b is
  /// consistent.
  void solve(const Vector& b, Eigen::Ref<Eigen::VectorXd> x) const;
  /// Solves G^T y = b for b in rowSpace(), with zeros in y for the rows that depend on others.
  void solveTransposed(const Vector& b, Eigen::Ref<Eigen::VectorXd> y) const;
  /// Computes vector i of a basis, not orthonormal, of the y with G^T y = 0; there are rows() less
  /// rank() of them. It agrees with rank() and nullSpace(), as it follows from the same triangle.
  void leftNullVector(Eigen::Index i, Eigen::Ref<Eigen::VectorXd> y) const;

  /// Orthonormal columns, rank() of them, that span the space of the rows.
  auto rowSpace() const { return Q_.topLeftCorner(columns_, rank_); }
  /// Orthonormal columns, redundancy() of them, that span the null space.
  auto nullSpace() const { return Q_.block(0, rank_, columns_, redundancy()); }

 private:
  void reflect(Eigen::Index step);
  void substituteBack(Eigen::Ref<Eigen::VectorXd> y) const;
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
