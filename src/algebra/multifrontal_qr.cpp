#include "algebra/multifrontal_qr.h"

#include <algorithm>
#include <limits>

namespace virtual_work_dynamics {

namespace {

constexpr double kWorstCondition = 1e6;
// Distance kept from the tolerance of the rank, as the estimated condition number is a lower bound.
constexpr double kFarFromTolerance = 1e-2;

}  // namespace

MultifrontalQr::MultifrontalQr(const std::vector<RowBlock>& blocks, int columns)
    : layout_(blocks, columns),
      kernel_(&frontKernelFor(chosenInstructionSet())),
      numbers_(layout_.numbers() * sizeof(double)),
      states_(layout_.fronts().size()),
      stairs_(layout_.stairs()) {
  for (const RowBlock& block : blocks) {
    entries_.emplace_back(block.rows, static_cast<Eigen::Index>(block.columns.size()));
  }
  for (const Eigen::MatrixXd& entries : entries_) entries_data_.push_back(entries.data());
  null_rows_.reserve(layout_.rows());
  touched_.reserve(entries_.size());
  open_.reserve(states_.size());
}

bool MultifrontalQr::factorize(double worst_condition, double size) {
  condition_ = std::numeric_limits<double>::infinity();
  null_rows_listed_ = false;
  const Factorized done =
      kernel_->one.factorize(layout_.view(), entries_data_.data(), size, memory(), &condition_);
  return done == Factorized::kWhole && condition_ <= worst_condition;
}

double MultifrontalQr::sureCondition(double rank_tolerance) {
  return std::min(kWorstCondition, kFarFromTolerance / rank_tolerance);
}

void MultifrontalQr::take(const double* numbers, const FrontState* states, const int* stairs,
                          double condition, std::size_t width, std::size_t which, bool whole) {
  condition_ = condition;
  null_rows_listed_ = false;
  if (!whole) return;
  double* const own = static_cast<double*>(numbers_.get());
  for (std::size_t i = 0; i < layout_.usedNumbers(); ++i) own[i] = numbers[i * width + which];
  std::copy_n(states, states_.size(), states_.data());
  std::copy_n(stairs, layout_.usedStairs(), stairs_.data());
}

double MultifrontalQr::nullSquare(Eigen::Index row) {
  const FrontLayout::RowPlace& place = layout_.placeOf(static_cast<std::size_t>(row));
  if (place.front < 0) return 1;
  double square;
  kernel_->one.nullSquare(layout_.view(), memory(), place.front, place.row, &square);
  return square;
}

void MultifrontalQr::listNullRows() {
  if (null_rows_listed_) return;
  null_rows_listed_ = true;
  null_rows_.clear();
  for (int row = 0; row < static_cast<int>(rows()); ++row) {
    if (layout_.placeOf(static_cast<std::size_t>(row)).front < 0) null_rows_.push_back({-1, row});
  }
  for (int f = 0; f < layout_.view().front_count; ++f) {
    const FrontState& state = states_[static_cast<std::size_t>(f)];
    for (int row = state.steps; row < state.rows; ++row) null_rows_.push_back({f, row});
  }
}

double* MultifrontalQr::zOf(std::size_t front) {
  return static_cast<double*>(numbers_.get()) + layout_.view().fronts[front].z;
}

// Sets the z of a front to zero and notes that it is to be multiplied by its reflections.
void MultifrontalQr::startVector(std::size_t front) {
  std::fill_n(zOf(front), layout_.view().fronts[front].most_rows, 0.0);
  open_.push_back(front);
}

void MultifrontalQr::setUnitVector(int row, Eigen::Ref<Eigen::VectorXd> x) {
  std::size_t block = 0;
  while (firstOf(block + 1) <= row) ++block;
  x.segment(firstOf(block), firstOf(block + 1) - firstOf(block)).setZero();
  x[row] = 1;
  touched_.push_back(block);
}

void MultifrontalQr::nullVector(std::size_t i, Eigen::Ref<Eigen::VectorXd> x) {
  listNullRows();
  touched_.clear();
  open_.clear();
  const NullRow& null_row = null_rows_[i];
  if (null_row.front < 0) return setUnitVector(null_row.row, x);
  startVector(static_cast<std::size_t>(null_row.front));
  zOf(static_cast<std::size_t>(null_row.front))[null_row.row] = 1;
  while (!open_.empty()) {
    const std::size_t f = open_.back();
    open_.pop_back();
    kernel_->one.reflectBack(layout_.view(), memory(), static_cast<int>(f));
    const double* z = zOf(f);
    for (const std::size_t b : layout_.fronts()[f].blocks) {
      for (Eigen::Index row = firstOf(b); row < firstOf(b + 1); ++row) {
        x[row] = layout_.placeOf(static_cast<std::size_t>(row)).front < 0 ? 0 : *z++;
      }
      touched_.push_back(b);
    }
    for (const std::size_t child : layout_.fronts()[f].children) {
      const int first = layout_.view().fronts[child].pivots;
      const int remaining = states_[child].steps - first;
      const double* const end = z + remaining;
      if (std::any_of(z, end, [](double entry) { return entry != 0; })) {
        startVector(child);
        std::copy(z, end, zOf(child) + first);
      }
      z = end;
    }
  }
}

}  // namespace virtual_work_dynamics
