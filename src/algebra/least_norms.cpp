#include "algebra/least_norms.h"

#include <algorithm>

namespace virtual_work_dynamics {

namespace {

constexpr double kNoCost = 1e-10;

}  // namespace

LeastNorms::LeastNorms(Eigen::Index unknowns, Eigen::Index most_costs)
    : space_(unknowns, unknowns),
      next_space_(unknowns, unknowns),
      costs_(most_costs, unknowns),
      costs_transposed_(unknowns, most_costs),
      now_(most_costs),
      along_(std::max(most_costs, unknowns)),
      chosen_(unknowns),
      by_rows_(most_costs, unknowns),
      by_columns_(unknowns, most_costs) {}

void LeastNorms::start(const Eigen::Ref<const Eigen::MatrixXd>& basis) {
  open_ = basis.cols();
  space_.leftCols(open_) = basis;
}

// Minimizes |C y + c|: c is first projected on the range of C, so that the rows agree and can be
// solved for the y of least norm.
Eigen::Index LeastNorms::reduce(Eigen::Index rows, Eigen::VectorXd& x) {
  if (open_ == 0 || rows == 0) return 0;
  by_rows_.factorize(costs(rows), kNoCost, kNoCost);
  const Eigen::Index rank = by_rows_.rank();
  if (rank == 0) return 0;
  auto transposed = costs_transposed_.topLeftCorner(open_, rows);
  transposed = costs(rows).transpose();
  by_columns_.factorize(transposed, kNoCost, kNoCost);
  const auto range = by_columns_.rowSpace();
  auto along = along_.head(range.cols());
  along.noalias() = range.transpose() * now_.head(rows);
  now_.head(rows).noalias() = -range * along;
  auto chosen = chosen_.head(open_);
  by_rows_.solve(now_.head(rows), chosen);
  x.noalias() += space() * chosen;
  const Eigen::Index left = open_ - rank;
  next_space_.leftCols(left).noalias() = space() * by_rows_.nullSpace();
  space_.swap(next_space_);
  open_ = left;
  return rank;
}

void LeastNorms::finish(Eigen::VectorXd& x) {
  auto along = along_.head(open_);
  along.noalias() = space().transpose() * x;
  x.noalias() -= space() * along;
}

}  // namespace virtual_work_dynamics
