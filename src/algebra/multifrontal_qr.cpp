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

// The kernels below are loops over plain numbers, as fronts of single loops have few rows: what
// Eigen does for sizes known only at run time would cost more than the numbers themselves.

double dot(const double* a, const double* b, Eigen::Index count) {
  double even = 0, odd = 0;
  Eigen::Index i = 0;
  for (; i + 1 < count; i += 2) {
    even += a[i] * b[i];
    odd += a[i + 1] * b[i + 1];
  }
  if (i < count) even += a[i] * b[i];
  return even + odd;
}

void subtract(double factor, const double* what, double* from, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i) from[i] -= factor * what[i];
}

// Sets the places in `whole` of the columns of `part`.
void setPlaces(const std::vector<int>& whole, const std::vector<int>& part,
               std::vector<Eigen::Index>& places) {
  for (std::size_t i = 0; i < part.size(); ++i) {
    places[i] = std::find(whole.begin(), whole.end(), part[i]) - whole.begin();
  }
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
    work.pivots = size(front.pivots);
    work.order = work.start = front.pivots;
    work.order.insert(work.order.end(), front.rest.begin(), front.rest.end());
    Eigen::Index most_rows = 0;
    for (const std::size_t b : front.blocks) {
      most_rows += blocks[b].rows;
      work.places.emplace_back(blocks[b].columns.size());
    }
    for (const std::size_t child : front.children) {
      most_rows += std::min(work_[child].F.rows(), size(fronts_[child].rest));
      work.places.emplace_back(fronts_[child].rest.size());
    }
    const Eigen::Index width = size(work.order);
    work.F.resize(most_rows, width);
    work.z.resize(most_rows);
    work.factors.resize(std::min(most_rows, width));
    work.stairs.resize(static_cast<std::size_t>(std::min(most_rows, width)));
    work_.push_back(std::move(work));
    orderPivots(work_.size() - 1);
  }
  setPlacesOfRows();
  null_rows_.reserve(static_cast<std::size_t>(rows_));
  touched_.reserve(blocks_.size());
  open_.reserve(fronts_.size());
}

void MultifrontalQr::setPlacesOfRows() {
  places_.resize(static_cast<std::size_t>(rows_));
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    parents_.push_back(f);
    for (const std::size_t child : fronts_[f].children) parents_[child] = f;
    Eigen::Index row = 0;
    for (const std::size_t b : fronts_[f].blocks) {
      for (Eigen::Index i = first_[b]; i < first_[b + 1]; ++i) {
        places_[static_cast<std::size_t>(i)] = {f, row++};
      }
    }
  }
}

void MultifrontalQr::setPresent(const std::vector<bool>& present) {
  if (present_ == present) return;
  present_ = present;
  for (std::size_t f = 0; f < fronts_.size(); ++f) orderPivots(f);
}

// Puts the pivots that are part of M first, so that the others need not be looked at.
void MultifrontalQr::orderPivots(std::size_t f) {
  const Front& front = fronts_[f];
  Work& work = work_[f];
  auto next = work.start.begin();
  for (const bool part : {true, false}) {
    for (const int column : front.pivots) {
      if (present_[std::size_t(column)] == part) *next++ = column;
    }
    if (part) work.present = next - work.start.begin();
  }
  std::copy(work.start.begin(), work.start.end(), work.order.begin());
  auto places = work.places.begin();
  for (const std::size_t b : front.blocks) setPlaces(work.order, blocks_[b].columns, *places++);
  for (const std::size_t child : front.children) {
    setPlaces(work.order, fronts_[child].rest, *places++);
  }
}

void MultifrontalQr::assemble(std::size_t f) {
  const Front& front = fronts_[f];
  Work& work = work_[f];
  std::copy(work.start.begin(), work.start.end(), work.order.begin());
  std::fill_n(work.F.data(), work.F.size(), 0.0);
  Eigen::Index row = 0;
  auto places = work.places.begin();
  for (const std::size_t b : front.blocks) {
    const Eigen::MatrixXd& entries = entries_[b];
    const Eigen::Index count = entries.rows();
    for (std::size_t j = 0; j < places->size(); ++j) {
      const std::size_t column = static_cast<std::size_t>(blocks_[b].columns[j]);
      if (!present_[column]) continue;
      const double* from = entries.data() + Eigen::Index(j) * count;
      std::copy_n(from, count, work.column((*places)[j]) + row);
      lengths_[Eigen::Index(column)] += dot(from, from, count);
    }
    row += count;
    ++places;
  }
  for (const std::size_t child : front.children) {
    const Work& from = work_[child];
    for (Eigen::Index step = from.present; step < from.steps; ++step, ++row) {
      for (Eigen::Index j = from.stairs[std::size_t(step)]; j < from.width(); ++j) {
        work.F(row, (*places)[std::size_t(j - from.pivots)]) = from.F(step, j);
      }
    }
    ++places;
  }
  work.rows = row;
}

// H = 1 - factor v v^T with v = (1, below the step's row) turns the rest of a column into its norm.
void MultifrontalQr::reflect(Work& work, Eigen::Index step, Eigen::Index column) {
  const Eigen::Index below = work.rows - step - 1;
  double* tail = work.column(column) + step;
  const double head = *tail++;
  const double norm = std::sqrt(head * head + dot(tail, tail, below));
  work.stairs[std::size_t(step)] = column;
  work.factors[step] = 0;
  if (norm == 0) return;
  const double diagonal = head > 0 ? -norm : norm;
  const double factor = (diagonal - head) / diagonal, scale = 1 / (head - diagonal);
  work.factors[step] = factor;
  for (Eigen::Index i = 0; i < below; ++i) tail[i] *= scale;
  tail[-1] = diagonal;
  // Columns that are no part of M have no entries.
  const auto after = [&](Eigen::Index j) { return j + 1 == work.present ? work.pivots : j + 1; };
  for (Eigen::Index j = after(column); j < work.width(); j = after(j)) {
    double* other = work.column(j) + step;
    const double along = factor * (*other + dot(tail, other + 1, below));
    *other -= along;
    subtract(along, tail, other + 1, below);
  }
}

// Applies the reflection of a step to z.
void MultifrontalQr::reflectVector(Work& work, Eigen::Index step) {
  const Eigen::Index below = work.rows - step - 1;
  const double* tail = work.reflector(step);
  double* z = work.z.data() + step;
  const double along = work.factors[step] * (*z + dot(tail, z + 1, below));
  *z -= along;
  subtract(along, tail, z + 1, below);
}

bool MultifrontalQr::eliminate(std::size_t f) {
  Work& work = work_[f];
  if (work.present > work.rows) return false;
  for (Eigen::Index step = 0; step < work.present; ++step) {
    Eigen::Index pivot = step;
    double longest = -1;
    for (Eigen::Index j = step; j < work.present; ++j) {
      const double* column = work.column(j) + step;
      const double length = dot(column, column, work.rows - step);
      if (length > longest) {
        longest = length;
        pivot = j;
      }
    }
    if (!(longest > 0)) return false;
    if (pivot != step) {
      std::swap_ranges(work.column(step), work.column(step) + work.rows, work.column(pivot));
      std::swap(work.order[std::size_t(step)], work.order[std::size_t(pivot)]);
    }
    reflect(work, step, step);
  }
  return true;
}

// Reflects the rows below the pivots into as few rows as their entries allow; the other rows then
// have no entries.
void MultifrontalQr::compress(std::size_t f) {
  Work& work = work_[f];
  work.steps = work.present;
  double longest = 0;
  for (Eigen::Index j = work.pivots; j < work.width(); ++j) {
    longest = std::max(longest, dot(work.column(j), work.column(j), work.rows));
  }
  const double nothing = kRounding * kRounding * longest;
  for (Eigen::Index j = work.pivots; j < work.width() && work.steps < work.rows; ++j) {
    const double* column = work.column(j) + work.steps;
    if (dot(column, column, work.rows - work.steps) <= nothing) continue;
    reflect(work, work.steps, j);
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
    double* z = work.z.data();
    for (Eigen::Index k = 0; k < work.present; ++k) {
      const double sum = sums_[work.order[std::size_t(k)]] + dot(work.column(k), z, k);
      z[k] = -(sum + (sum < 0 ? -1 : 1)) / work.F(k, k);
      before += z[k] * z[k];
    }
    for (Eigen::Index j = work.pivots; j < work.width(); ++j) {
      sums_[work.order[std::size_t(j)]] += dot(work.column(j), z, work.present);
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
  double* z = work.z.data();
  for (Eigen::Index j = work.pivots; j < work.width(); ++j) {
    const int column = work.order[std::size_t(j)];
    if (!present_[std::size_t(column)]) continue;
    subtract(solution_[column], work.column(j), z, work.present);
  }
  for (Eigen::Index k = work.present; k-- > 0;) {
    const double* column = work.column(k);
    const double value = z[k] / column[k];
    solution_[work.order[std::size_t(k)]] = value;
    subtract(value, column, z, k);
  }
}

void MultifrontalQr::applyQ(Work& work) {
  for (Eigen::Index step = work.steps; step-- > 0;) reflectVector(work, step);
}

void MultifrontalQr::applyQTransposed(Work& work) {
  for (Eigen::Index step = 0; step < work.steps; ++step) reflectVector(work, step);
}

// Hands the rows of a front, computed by applyQ(), on to its blocks' entries of x and its children.
void MultifrontalQr::scatter(std::size_t f, Eigen::Ref<Eigen::VectorXd> x) {
  const double* z = work_[f].z.data();
  for (const std::size_t b : fronts_[f].blocks) {
    std::copy_n(z, blocks_[b].rows, x.data() + first_[b]);
    z += blocks_[b].rows;
  }
  for (const std::size_t child : fronts_[f].children) {
    Work& to = work_[child];
    std::copy_n(z, remaining(child), to.z.data() + to.present);
    z += remaining(child);
  }
}

// Solves the part of R^T y = b that belongs to a front; called from the first front to the last.
void MultifrontalQr::solveTransposed(std::size_t f) {
  Work& work = work_[f];
  double* z = work.z.data();
  for (Eigen::Index k = 0; k < work.present; ++k) {
    const double* column = work.column(k);
    z[k] = (sums_[work.order[std::size_t(k)]] - dot(column, z, k)) / column[k];
  }
  for (Eigen::Index j = work.pivots; j < work.width(); ++j) {
    sums_[work.order[std::size_t(j)]] -= dot(work.column(j), z, work.present);
  }
}

void MultifrontalQr::leastNorm(const Vector& b, Eigen::Ref<Eigen::VectorXd> x) {
  sums_ = b;
  for (std::size_t f = 0; f < fronts_.size(); ++f) solveTransposed(f);
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    Work& work = work_[f];
    std::fill_n(work.z.data() + work.steps, work.rows - work.steps, 0.0);
    applyQ(work);
    scatter(f, x);
  }
}

void MultifrontalQr::leastSquares(const Vector& r, Eigen::Ref<Eigen::VectorXd> u) {
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Work& work = work_[f];
    double* z = work.z.data();
    for (const std::size_t b : fronts_[f].blocks) {
      z = std::copy_n(r.data() + first_[b], blocks_[b].rows, z);
    }
    for (const std::size_t child : fronts_[f].children) {
      z = std::copy_n(work_[child].z.data() + work_[child].present, remaining(child), z);
    }
    applyQTransposed(work);
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) backSubstitute(f);
  for (Eigen::Index j = 0; j < columns_; ++j) u[j] = present_[std::size_t(j)] ? solution_[j] : 0;
}

// Goes from the row's front to the last one that its part reaches.
double MultifrontalQr::nullSquare(Eigen::Index row) {
  std::size_t f = places_[static_cast<std::size_t>(row)].front;
  work_[f].z.head(work_[f].rows).setZero();
  work_[f].z[places_[static_cast<std::size_t>(row)].row] = 1;
  double square = 0;
  while (true) {
    Work& work = work_[f];
    applyQTransposed(work);
    const double* z = work.z.data();
    square += dot(z + work.steps, z + work.steps, work.rows - work.steps);
    const std::size_t parent = parents_[f];
    if (parent == f || remaining(f) == 0) return square;
    Work& next = work_[parent];
    next.z.head(next.rows).setZero();
    Eigen::Index at = 0;
    for (const std::size_t b : fronts_[parent].blocks) at += blocks_[b].rows;
    for (const std::size_t child : fronts_[parent].children) {
      if (child == f) break;
      at += remaining(child);
    }
    std::copy_n(z + work.present, remaining(f), next.z.data() + at);
    f = parent;
  }
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
