#include "algebra/multifrontal_qr.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace virtual_work_dynamics {

namespace {

// Remainders of columns after the reflections of a front count as rounding up to this fraction of
// the longest column.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
constexpr double kWorstCondition = 1e6;
// Distance kept from the tolerance of the rank, as the estimated condition number is a lower bound.
constexpr double kFarFromTolerance = 1e-2;

Eigen::Index size(const std::vector<int>& list) {
  return static_cast<Eigen::Index>(list.size());
}

// The places in `whole` of the columns of `part`.
std::vector<Eigen::Index> placesIn(const std::vector<int>& whole, const std::vector<int>& part) {
  std::vector<Eigen::Index> places;
  for (const int column : part) {
    places.push_back(std::find(whole.begin(), whole.end(), column) - whole.begin());
  }
  return places;
}

}  // namespace

MultifrontalQr::MultifrontalQr(const std::vector<RowBlock>& blocks, int columns)
    : blocks_(blocks),
      fronts_(eliminationOrder(blocks, columns)),
      columns_(columns),
      present_(static_cast<std::size_t>(columns), true),
      lengths_(columns),
      sums_(columns),
      solution_(columns) {
  for (const RowBlock& block : blocks) {
    first_.push_back(rows_);
    rows_ += block.rows;
    entries_.emplace_back(block.rows, size(block.columns));
  }
  first_.push_back(rows_);
  for (const Front& front : fronts_) {
    Work work;
    work.order = front.pivots;
    work.order.insert(work.order.end(), front.rest.begin(), front.rest.end());
    Eigen::Index most_rows = 0;
    for (const std::size_t b : front.blocks) {
      most_rows += blocks[b].rows;
      work.places.push_back(placesIn(work.order, blocks[b].columns));
    }
    for (const std::size_t child : front.children) {
      most_rows += std::min(work_[child].F.rows(), size(fronts_[child].rest));
      work.places.push_back(placesIn(work.order, fronts_[child].rest));
    }
    const Eigen::Index width = size(work.order);
    work.F.resize(most_rows, width);
    work.z.resize(most_rows);
    work.factors.resize(std::min(most_rows, width));
    work.stairs.resize(static_cast<std::size_t>(std::min(most_rows, width)));
    work_.push_back(std::move(work));
  }
  null_rows_.reserve(static_cast<std::size_t>(rows_));
  touched_.reserve(blocks_.size());
  open_.reserve(fronts_.size());
}

void MultifrontalQr::setPresent(const std::vector<bool>& present) {
  present_ = present;
}

void MultifrontalQr::assemble(std::size_t f) {
  const Front& front = fronts_[f];
  Work& work = work_[f];
  std::copy(front.pivots.begin(), front.pivots.end(), work.order.begin());
  work.F.setZero();
  Eigen::Index row = 0;
  auto places = work.places.begin();
  for (const std::size_t b : front.blocks) {
    const Eigen::MatrixXd& entries = entries_[b];
    for (Eigen::Index j = 0; j < entries.cols(); ++j) {
      const std::size_t column = static_cast<std::size_t>(blocks_[b].columns[std::size_t(j)]);
      if (!present_[column]) continue;
      work.F.col((*places)[std::size_t(j)]).segment(row, entries.rows()) = entries.col(j);
      lengths_[Eigen::Index(column)] += entries.col(j).squaredNorm();
    }
    row += entries.rows();
    ++places;
  }
  for (const std::size_t child : front.children) {
    const Work& from = work_[child];
    const Eigen::Index pivots = size(fronts_[child].pivots);
    for (Eigen::Index step = from.present; step < from.steps; ++step, ++row) {
      for (Eigen::Index j = from.stairs[std::size_t(step)]; j < from.F.cols(); ++j) {
        work.F(row, (*places)[std::size_t(j - pivots)]) = from.F(step, j);
      }
    }
    ++places;
  }
  work.rows = row;
}

// H = 1 - factor v v^T with v = (1, below the step's row) turns the rest of a column into its norm.
void MultifrontalQr::reflect(Work& work, Eigen::Index step, Eigen::Index column,
                             Eigen::Index last) {
  const Eigen::Index below = work.rows - step - 1;
  auto tail = work.F.col(column).segment(step + 1, below);
  const double head = work.F(step, column);
  const double norm = std::hypot(head, tail.norm());
  work.stairs[std::size_t(step)] = column;
  work.factors[step] = 0;
  if (norm == 0) return;
  const double diagonal = head > 0 ? -norm : norm;
  work.factors[step] = (diagonal - head) / diagonal;
  tail /= head - diagonal;
  work.F(step, column) = diagonal;
  for (Eigen::Index j = column + 1; j < last; ++j) {
    auto other = work.F.col(j).segment(step + 1, below);
    const double along = work.factors[step] * (work.F(step, j) + tail.dot(other));
    work.F(step, j) -= along;
    other -= along * tail;
  }
}

bool MultifrontalQr::eliminate(std::size_t f) {
  Work& work = work_[f];
  const Eigen::Index pivots = size(fronts_[f].pivots);
  work.present = 0;
  for (const int column : fronts_[f].pivots) work.present += present_[std::size_t(column)];
  if (work.present > work.rows) return false;
  for (Eigen::Index step = 0; step < work.present; ++step) {
    Eigen::Index pivot = step;
    double longest = -1;
    for (Eigen::Index j = step; j < pivots; ++j) {
      const double length = work.F.col(j).segment(step, work.rows - step).squaredNorm();
      if (length > longest && present_[std::size_t(work.order[std::size_t(j)])]) {
        longest = length;
        pivot = j;
      }
    }
    if (!(longest > 0)) return false;
    if (pivot != step) {
      work.F.col(step).swap(work.F.col(pivot));
      std::swap(work.order[std::size_t(step)], work.order[std::size_t(pivot)]);
    }
    reflect(work, step, step, work.F.cols());
  }
  return true;
}

// Reflects the rows below the pivots into as few rows as their entries allow; the other rows then
// have no entries.
void MultifrontalQr::compress(std::size_t f) {
  Work& work = work_[f];
  const Eigen::Index pivots = size(fronts_[f].pivots);
  double longest = 0;
  for (Eigen::Index j = pivots; j < work.F.cols(); ++j) {
    longest = std::max(longest, work.F.col(j).head(work.rows).squaredNorm());
  }
  const double nothing = kRounding * kRounding * longest;
  work.steps = work.present;
  for (Eigen::Index j = pivots; j < work.F.cols() && work.steps < work.rows; ++j) {
    const double length = work.F.col(j).segment(work.steps, work.rows - work.steps).squaredNorm();
    if (length <= nothing) continue;
    reflect(work, work.steps, j, work.F.cols());
    ++work.steps;
  }
  for (Eigen::Index row = work.steps; row < work.rows; ++row) null_rows_.push_back({f, row});
}

bool MultifrontalQr::factorize(double worst_condition, double size) {
  condition_ = std::numeric_limits<double>::infinity();
  lengths_.setZero();
  null_rows_.clear();
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    assemble(f);
    if (!eliminate(f)) return false;
    compress(f);
  }
  longest_ = std::max(size, columns_ > 0 ? std::sqrt(lengths_.maxCoeff()) : 0);
  estimateCondition();
  return condition_ <= worst_condition;
}

double MultifrontalQr::sureCondition(double rank_tolerance) {
  return std::min(kWorstCondition, kFarFromTolerance / rank_tolerance);
}

// Estimates |R^-1| by |R^-1 (R^-T d)| / |R^-T d|, where d = +-1 with the signs that make each entry
// of R^-T d large as it is computed.
void MultifrontalQr::estimateCondition() {
  sums_.setZero();
  double before = 0;
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Work& work = work_[f];
    for (Eigen::Index k = 0; k < work.present; ++k) {
      const Eigen::Index column = work.order[std::size_t(k)];
      const double sum = sums_[column] + work.F.col(k).head(k).dot(work.z.head(k));
      work.z[k] = -(sum + (sum < 0 ? -1 : 1)) / work.F(k, k);
      before += work.z[k] * work.z[k];
    }
    for (Eigen::Index j = size(fronts_[f].pivots); j < work.F.cols(); ++j) {
      sums_[work.order[std::size_t(j)]] +=
          work.F.col(j).head(work.present).dot(work.z.head(work.present));
    }
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) backSubstitute(f);
  double after = 0;
  for (Eigen::Index j = 0; j < columns_; ++j) {
    if (present_[std::size_t(j)]) after += solution_[j] * solution_[j];
  }
  condition_ = before > 0 ? longest_ * std::sqrt(after / before) : 1;
}

// Solves the part of R u = z that belongs to a front; called from the last front to the first.
void MultifrontalQr::backSubstitute(std::size_t f) {
  Work& work = work_[f];
  for (Eigen::Index j = size(fronts_[f].pivots); j < work.F.cols(); ++j) {
    const int column = work.order[std::size_t(j)];
    if (!present_[std::size_t(column)]) continue;
    work.z.head(work.present) -= solution_[column] * work.F.col(j).head(work.present);
  }
  for (Eigen::Index k = work.present; k-- > 0;) {
    const double value = work.z[k] / work.F(k, k);
    solution_[work.order[std::size_t(k)]] = value;
    work.z.head(k) -= value * work.F.col(k).head(k);
  }
}

void MultifrontalQr::applyQ(Work& work) {
  for (Eigen::Index step = work.steps; step-- > 0;) {
    const Eigen::Index below = work.rows - step - 1;
    const auto tail = work.F.col(work.stairs[std::size_t(step)]).segment(step + 1, below);
    const double along =
        work.factors[step] * (work.z[step] + tail.dot(work.z.segment(step + 1, below)));
    work.z[step] -= along;
    work.z.segment(step + 1, below) -= along * tail;
  }
}

void MultifrontalQr::applyQTransposed(Work& work) {
  for (Eigen::Index step = 0; step < work.steps; ++step) {
    const Eigen::Index below = work.rows - step - 1;
    const auto tail = work.F.col(work.stairs[std::size_t(step)]).segment(step + 1, below);
    const double along =
        work.factors[step] * (work.z[step] + tail.dot(work.z.segment(step + 1, below)));
    work.z[step] -= along;
    work.z.segment(step + 1, below) -= along * tail;
  }
}

// Hands the rows of a front, computed by applyQ(), on to its blocks' entries of x and its children.
void MultifrontalQr::scatter(std::size_t f, Eigen::Ref<Eigen::VectorXd> x) {
  const Work& work = work_[f];
  Eigen::Index row = 0;
  for (const std::size_t b : fronts_[f].blocks) {
    x.segment(first_[b], blocks_[b].rows) = work.z.segment(row, blocks_[b].rows);
    row += blocks_[b].rows;
  }
  for (const std::size_t child : fronts_[f].children) {
    Work& to = work_[child];
    to.z.segment(to.present, remaining(child)) = work.z.segment(row, remaining(child));
    row += remaining(child);
  }
}

// Solves the part of R^T y = b that belongs to a front; called from the first front to the last.
void MultifrontalQr::solveTransposed(std::size_t f) {
  Work& work = work_[f];
  for (Eigen::Index k = 0; k < work.present; ++k) {
    const double sum = sums_[work.order[std::size_t(k)]];
    work.z[k] = (sum - work.F.col(k).head(k).dot(work.z.head(k))) / work.F(k, k);
  }
  for (Eigen::Index j = size(fronts_[f].pivots); j < work.F.cols(); ++j) {
    sums_[work.order[std::size_t(j)]] -=
        work.F.col(j).head(work.present).dot(work.z.head(work.present));
  }
}

void MultifrontalQr::leastNorm(const Vector& b, Eigen::Ref<Eigen::VectorXd> x) {
  sums_ = b;
  for (std::size_t f = 0; f < fronts_.size(); ++f) solveTransposed(f);
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    Work& work = work_[f];
    work.z.segment(work.steps, work.rows - work.steps).setZero();
    applyQ(work);
    scatter(f, x);
  }
}

void MultifrontalQr::leastSquares(const Vector& r, Eigen::Ref<Eigen::VectorXd> u) {
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Work& work = work_[f];
    Eigen::Index row = 0;
    for (const std::size_t b : fronts_[f].blocks) {
      work.z.segment(row, blocks_[b].rows) = r.segment(first_[b], blocks_[b].rows);
      row += blocks_[b].rows;
    }
    for (const std::size_t child : fronts_[f].children) {
      const Work& from = work_[child];
      work.z.segment(row, remaining(child)) = from.z.segment(from.present, remaining(child));
      row += remaining(child);
    }
    applyQTransposed(work);
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) backSubstitute(f);
  for (Eigen::Index j = 0; j < columns_; ++j) u[j] = present_[std::size_t(j)] ? solution_[j] : 0;
}

void MultifrontalQr::nullVector(std::size_t i, Eigen::Ref<Eigen::VectorXd> x) {
  touched_.clear();
  open_.clear();
  const NullRow& null_row = null_rows_[i];
  work_[null_row.front].z.head(work_[null_row.front].rows).setZero();
  work_[null_row.front].z[null_row.row] = 1;
  open_.push_back(null_row.front);
  while (!open_.empty()) {
    const std::size_t f = open_.back();
    open_.pop_back();
    Work& work = work_[f];
    applyQ(work);
    scatter(f, x);
    touched_.insert(touched_.end(), fronts_[f].blocks.begin(), fronts_[f].blocks.end());
    for (const std::size_t child : fronts_[f].children) {
      Work& below = work_[child];
      if (below.z.segment(below.present, remaining(child)).isZero(0)) continue;
      below.z.head(below.present).setZero();
      below.z.segment(below.steps, below.rows - below.steps).setZero();
      open_.push_back(child);
    }
  }
}

}  // namespace virtual_work_dynamics
