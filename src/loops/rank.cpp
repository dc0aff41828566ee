#include "loops/rank.h"

#include <algorithm>
#include <utility>

namespace virtual_work_dynamics {

namespace {

// Rounds of orthogonalisation: a second one removes what rounding leaves of the first.
constexpr int kRounds = 2;

}  // namespace

LoopRank::LoopRank(Eigen::VectorXd sizes, Eigen::Index most_columns, double tolerance)
    : sizes_(std::move(sizes)),
      largest_(sizes_.size() > 0 ? sizes_.maxCoeff() : 0),
      used_(sizes_),
      scaled_(sizes_.size(), most_columns),
      places_(static_cast<std::size_t>(most_columns)),
      factorization_(sizes_.size(), most_columns),
      tolerance_(tolerance),
      right_(sizes_.size()),
      packed_(most_columns) {}

void LoopRank::decide(const MultifrontalQr& of, const std::vector<bool>& present) {
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < present.size(); ++i) {
    places_[i] = present[i] ? static_cast<int>(count++) : -1;
  }
  auto M = scaled_.leftCols(count);
  M.setZero();
  for (std::size_t b = 0; b < of.blocks(); ++b) {
    const Eigen::MatrixXd& entries = of.entriesOf(b);
    const Eigen::Index first = of.firstOf(b);
    for (Eigen::Index i = 0; i < entries.rows(); ++i) {
      for (Eigen::Index k = 0; k < entries.cols(); ++k) {
        const int place = places_[static_cast<std::size_t>(of.columnsOf(b)[std::size_t(k)])];
        if (place >= 0) M(first + i, place) = entries(i, k);
      }
      // Entries of columns that are not present are not set.
      double& size = used_[first + i];
      size = sizes_[first + i];
      if (size == 0) size = M.row(first + i).norm();
      if (size == 0) size = 1;
      M.row(first + i) /= size;
    }
  }
  factorization_.factorize(M, 0, tolerance_);
}

double LoopRank::condition() const {
  return rank() == 0 ? 1 : std::max(1.0, factorization_.largest()) / factorization_.least();
}

void LoopRank::solve(const Vector& right, Eigen::Ref<Eigen::VectorXd> u) {
  right_ = right.cwiseQuotient(used_);
  auto packed = packed_.head(columns());
  factorization_.solve(right_, packed);
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const int place = places_[static_cast<std::size_t>(i)];
    u[i] = place >= 0 ? packed[place] : 0;
  }
}

void LoopRank::getChanges(Eigen::Ref<Eigen::MatrixXd> changes) const {
  for (Eigen::Index j = 0; j < changes.cols(); ++j) {
    auto change = changes.col(j);
    factorization_.leftNullVector(j, change);
    change = change.cwiseQuotient(used_);
    for (int round = 0; round < kRounds; ++round) {
      for (Eigen::Index k = 0; k < j; ++k) change -= changes.col(k).dot(change) * changes.col(k);
    }
    change.normalize();
  }
}

void LoopRank::solveLoad(const Vector& load, Eigen::Ref<Eigen::VectorXd> x) const {
  factorization_.solveTransposed(load, x);
  x = x.cwiseQuotient(used_);
}

}  // namespace virtual_work_dynamics
