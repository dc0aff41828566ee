#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "algebra/front_layout.h"
#include "base/aligned_memory.h"

namespace virtual_work_dynamics {

/// Orthogonal factorisation M = Q R of a matrix of row blocks that couple few columns each, such as
/// the conditions of many loops. It solves M u = r in least squares and M^T x = b in least norm.
/// The cost grows with the number of blocks, not with its cube. Each front eliminates its own
/// columns in a fixed order, so that the factorisation recognizes full column rank but does not
/// tell a lower rank; RankFactorization does. Allocates in its constructor only.
class MultifrontalQr {
 public:
  MultifrontalQr(const std::vector<RowBlock>& blocks, int columns);

  const FrontLayout& layout() const { return layout_; }
  Eigen::Index rows() const { return static_cast<Eigen::Index>(layout_.rows()); }
  Eigen::Index columns() const { return layout_.view().column_count; }
  /// The first row of a block; rows() for blocks().
  Eigen::Index firstOf(std::size_t block) const { return layout_.firstOf(block); }
  std::size_t blocks() const { return entries_.size(); }
  /// The entries of a block, its rows x its columns; to be filled before factorize().
  Eigen::MatrixXd& entriesOf(std::size_t block) { return entries_[block]; }
  const Eigen::MatrixXd& entriesOf(std::size_t block) const { return entries_[block]; }
  const std::vector<int>& columnsOf(std::size_t block) const {
    return layout_.blocks()[block].columns;
  }

  /// Makes the columns with a true entry part of M and leaves out the others. Without this call all
  /// columns are part of M. Costs little when they are so already.
  /// @param present one entry for each column.
  void setPresent(const std::vector<bool>& present) { layout_.setPresent(present); }

  /// Factorizes M. Returns false when its columns are dependent, or so close to it that the
  /// condition number may be above `worst_condition`; then there is no factorisation.
  /// @param size length that rows would have without cancellation, which the condition number
  ///   counts from when it is longer than the longest column
  bool factorize(double worst_condition, double size = 0);
  /// A condition number up to which the rank is full beyond doubt: far from the tolerance of the
  /// rank, and low enough for rounding to stay far below 1e-8 of a null vector.
  static double sureCondition(double rank_tolerance);
  /// The estimated condition number of M: the length of the longest column, or the size of its
  /// rows, times an estimate of the norm of the inverse of R; also when that is why factorize()
  /// returned false. Infinite when columns are dependent.
  double condition() const { return condition_; }

  /// Computes the x of least norm with M^T x = b.
  /// @param b columns() numbers. @param x receives rows() numbers
  void leastNorm(const double* b, double* x) {
    kernel_->one.leastNorm(layout_.view(), memory(), b, x);
  }
  /// Computes the u for which |M u - r| is least; its entries for absent columns are not set.
  /// @param r rows() numbers. @param u receives columns() numbers
  void leastSquares(const double* r, double* u) {
    kernel_->one.leastSquares(layout_.view(), memory(), r, u);
  }

  /// Takes over a factorization of the same layout from a pack of them that were made side by side.
  /// @param numbers of all of them; `width` neighbouring ones belong together
  /// @param whole what null vectors need, too; else only the condition
  void take(const double* numbers, const FrontState* states, const int* stairs, double condition,
            std::size_t width, std::size_t which, bool whole);

  /// Number of vectors in an orthonormal basis of the null space, M^T x = 0.
  std::size_t nullity() const {
    return layout_.rows() - static_cast<std::size_t>(layout_.presentColumns());
  }
  /// The squared length of what the null space has of the unit vector of a row: zero when the row's
  /// entry of every null vector is.
  double nullSquare(Eigen::Index row);
  /// Computes vector i of that basis. Sets only the entries of x that belong to the blocks in
  /// touched(); the other entries of the vector are zero.
  void nullVector(std::size_t i, Eigen::Ref<Eigen::VectorXd> x);
  /// The blocks in which the latest nullVector() can have entries other than zero.
  const std::vector<std::size_t>& touched() const { return touched_; }

 private:
  /// A row of a front, or where that is -1 a row of the matrix that has no entries.
  struct NullRow {
    int front, row;
  };

  FrontsMemory memory() {
    return {static_cast<double*>(numbers_.get()), states_.data(), stairs_.data()};
  }
  void listNullRows();
  void setUnitVector(int row, Eigen::Ref<Eigen::VectorXd> x);
  double* zOf(std::size_t front);
  void startVector(std::size_t front);

  FrontLayout layout_;
  const FrontKernel* kernel_;
  std::vector<Eigen::MatrixXd> entries_;
  std::vector<const double*> entries_data_;
  AlignedMemory numbers_;
  std::vector<FrontState> states_;  // by front
  std::vector<int> stairs_;
  double condition_ = 1;
  std::vector<NullRow> null_rows_;  // of the latest factorization, once a null vector was wanted
  bool null_rows_listed_ = false;
  std::vector<std::size_t> touched_, open_;
};

}  // namespace virtual_work_dynamics
