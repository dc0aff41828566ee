#include "algebra/rank_factorization.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace virtual_work_dynamics {

RankFactorization::RankFactorization(Eigen::Index most_rows, Eigen::Index most_columns)
    : R_(most_columns, most_rows),
      Q_(most_columns, most_columns),
      factors_(std::min(most_rows, most_columns)),
      pivots_(static_cast<std::size_t>(most_rows)),
      work_(factors_.size()) {}

void RankFactorization::factorize(const Matrix& G, double relative, double absolute) {
  rows_ = G.rows();
  columns_ = G.cols();
  auto R = R_.topLeftCorner(columns_, rows_);
  R = G.transpose();
  std::iota(pivots_.begin(), pivots_.begin() + rows_, 0);
  rank_ = 0;
  double threshold = 0;
  for (Eigen::Index step = 0; step < steps(); ++step) {
    // Norms are computed anew, as downdated ones lose the digits that decide about the rank.
    Eigen::Index pivot = step;
    double norm = -1;
    for (Eigen::Index j = step; j < rows_; ++j) {
      const double candidate = R.col(j).tail(columns_ - step).norm();
      if (candidate > norm) {
        norm = candidate;
        pivot = j;
      }
    }
    if (step == 0) threshold = std::max(relative * norm, absolute);
    R.col(step).swap(R.col(pivot));
    std::swap(pivots_[static_cast<std::size_t>(step)], pivots_[static_cast<std::size_t>(pivot)]);
    reflect(step);
    if (norm > threshold) rank_ = step + 1;
  }
  accumulate();
}

// H = 1 - factor v v^T with v = (1, below the diagonal) turns the rest of the column into its norm.
void RankFactorization::reflect(Eigen::Index step) {
  const Eigen::Index below = columns_ - step - 1;
  auto tail = R_.col(step).segment(step + 1, below);
  const double head = R_(step, step);
  const double norm = std::hypot(head, tail.norm());
  factors_[step] = 0;
  if (norm == 0) return;
  const double diagonal = head > 0 ? -norm : norm;
  factors_[step] = (diagonal - head) / diagonal;
  tail /= head - diagonal;
  R_(step, step) = diagonal;
  for (Eigen::Index j = step + 1; j < rows_; ++j) {
    auto column = R_.col(j).segment(step + 1, below);
    const double along = factors_[step] * (R_(step, j) + tail.dot(column));
    R_(step, j) -= along;
    column -= along * tail;
  }
}

// Computes Q = H_1 H_2 ..., beginning with the last reflection.
void RankFactorization::accumulate() {
  Q_.topLeftCorner(columns_, columns_).setIdentity();
  for (Eigen::Index step = steps(); step-- > 0;) {
    const Eigen::Index below = columns_ - step - 1;
    const auto tail = R_.col(step).segment(step + 1, below);
    for (Eigen::Index j = step; j < columns_; ++j) {
      auto column = Q_.col(j).segment(step + 1, below);
      const double along = factors_[step] * (Q_(step, j) + tail.dot(column));
      Q_(step, j) -= along;
      column -= along * tail;
    }
  }
}

double RankFactorization::gap() const {
  if (rank_ == 0 || rank_ == steps()) return std::numeric_limits<double>::infinity();
  return std::abs(R_(rank_ - 1, rank_ - 1)) / std::abs(R_(rank_, rank_));
}

double RankFactorization::condition() const {
  return rank_ == 0 ? 1 : largest() / least();
}

// From G^T P = Q (R11 R12; 0 0) follows x = Q1 y, where R11^T y = the independent rows of P^T b.
void RankFactorization::solve(const Vector& b, Eigen::Ref<Eigen::VectorXd> x) const {
  for (Eigen::Index i = 0; i < rank_; ++i) {
    const double sum = b[pivots_[static_cast<std::size_t>(i)]];
    work_[i] = (sum - R_.col(i).head(i).dot(work_.head(i))) / R_(i, i);
  }
  x.setZero();
  for (Eigen::Index i = 0; i < rank_; ++i) x += work_[i] * Q_.col(i).head(columns_);
}

// Sets y to P (y', 0), where R11 y' is what work_ holds.
void RankFactorization::substituteBack(Eigen::Ref<Eigen::VectorXd> y) const {
  y.setZero();
  for (Eigen::Index i = rank_; i-- > 0;) {
    const double value = work_[i] / R_(i, i);
    y[pivots_[static_cast<std::size_t>(i)]] = value;
    work_.head(i) -= value * R_.col(i).head(i);
  }
}

void RankFactorization::solveTransposed(const Vector& b, Eigen::Ref<Eigen::VectorXd> y) const {
  for (Eigen::Index i = 0; i < rank_; ++i) work_[i] = Q_.col(i).head(columns_).dot(b);
  substituteBack(y);
}

void RankFactorization::leftNullVector(Eigen::Index i, Eigen::Ref<Eigen::VectorXd> y) const {
  work_.head(rank_) = -R_.col(rank_ + i).head(rank_);
  substituteBack(y);
  y[pivots_[static_cast<std::size_t>(rank_ + i)]] = 1;
}

}  // namespace virtual_work_dynamics
