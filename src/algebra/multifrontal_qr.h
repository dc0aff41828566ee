#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "algebra/elimination_order.h"

namespace virtual_work_dynamics {

/// Orthogonal factorisation M = Q R of a matrix of row blocks that couple few columns each, such as
/// the conditions of many loops. It solves M u = r in least squares and M^T x = b in least norm.
/// The cost grows with the number of blocks, not with its cube. Each front pivots among its own
/// columns only, so that the factorisation recognizes full column rank but does not tell a lower
/// rank; RankFactorization does. Allocates in its constructor only.
class MultifrontalQr {
 public:
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  MultifrontalQr(const std::vector<RowBlock>& blocks, int columns);

  Eigen::Index rows() const { return rows_; }
  Eigen::Index columns() const { return columns_; }
  /// The first row of a block; rows() for blocks().
  Eigen::Index firstOf(std::size_t block) const { return first_[block]; }
  std::size_t blocks() const { return blocks_.size(); }
  /// The entries of a block, its rows x its columns; to be filled before factorize().
  Eigen::MatrixXd& entriesOf(std::size_t block) { return entries_[block]; }
  const Eigen::MatrixXd& entriesOf(std::size_t block) const { return entries_[block]; }
  const std::vector<int>& columnsOf(std::size_t block) const { return blocks_[block].columns; }

  /// Makes the columns with a true entry part of M and leaves out the others. Without this call all
  /// columns are part of M. Costs little when they are so already.
  /// @param present one entry for each column.
  void setPresent(const std::vector<bool>& present);

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

  /// Computes the x of least norm with M^T x = b; b has an entry for each column.
  void leastNorm(const Vector& b, Eigen::Ref<Eigen::VectorXd> x);
  /// Computes the u for which |M u - r| is least; its entries for absent columns are zero.
  void leastSquares(const Vector& r, Eigen::Ref<Eigen::VectorXd> u);

  /// Number of vectors in an orthonormal basis of the null space, M^T x = 0.
  std::size_t nullity() const { return null_rows_.size(); }
  /// The squared length of what the null space has of the unit vector of a row: zero when the row's
  /// entry of every null vector is.
  double nullSquare(Eigen::Index row);
  /// Computes vector i of that basis. Sets only the entries of x that belong to the blocks in
  /// touched(); the other entries of the vector are zero.
  void nullVector(std::size_t i, Eigen::Ref<Eigen::VectorXd> x);
  /// The blocks in which the latest nullVector() can have entries other than zero.
  const std::vector<std::size_t>& touched() const { return touched_; }

 private:
  // The numbers of a front. Its rows are first those of the pivots, then those left for the next
  // front, then those that have no entries any more.
  struct Work {
    Eigen::MatrixXd F;                              // R above, reflections below
    Eigen::VectorXd factors;                        // factors of the reflections
    Eigen::VectorXd z;                              // a vector with an entry for each row
    std::vector<int> start;                         // pivots that are part of M, the other pivots
    std::vector<int> order;                         // columns: pivots, as chosen, then the rest
    std::vector<Eigen::Index> stairs;               // column of each reflection
    std::vector<std::vector<Eigen::Index>> places;  // of the columns of each block, then each child
    Eigen::Index pivots = 0, present = 0;  // columns that are pivots; those that are part of M
    Eigen::Index rows = 0, steps = 0;

    Eigen::Index width() const { return F.cols(); }
    double* column(Eigen::Index j) { return F.data() + j * F.rows(); }
    const double* column(Eigen::Index j) const { return F.data() + j * F.rows(); }
    // What step k reflects along, from below the step's row on.
    const double* reflector(Eigen::Index step) const {
      return column(stairs[static_cast<std::size_t>(step)]) + step + 1;
    }
  };
  struct NullRow {
    std::size_t front;
    Eigen::Index row;
  };

  void setPlacesOfRows();
  void orderPivots(std::size_t f);
  void assemble(std::size_t f);
  bool eliminate(std::size_t f);
  void compress(std::size_t f);
  void estimateCondition();
  static void reflect(Work& work, Eigen::Index step, Eigen::Index column);
  static void reflectVector(Work& work, Eigen::Index step);
  static void applyQ(Work& work);
  static void applyQTransposed(Work& work);
  Eigen::Index remaining(std::size_t f) const { return work_[f].steps - work_[f].present; }
  void solveTransposed(std::size_t f);
  void backSubstitute(std::size_t f);
  void scatter(std::size_t f, Eigen::Ref<Eigen::VectorXd> x);

  std::vector<RowBlock> blocks_;
  std::vector<Front> fronts_;
  Eigen::Index rows_ = 0, columns_;
  std::vector<Eigen::Index> first_;
  std::vector<Eigen::MatrixXd> entries_;
  std::vector<bool> present_;
  std::vector<Work> work_;
  Eigen::VectorXd lengths_;  // squared lengths of columns
  double longest_ = 0, condition_ = 1;
  Eigen::VectorXd sums_, solution_;  // by column
  std::vector<NullRow> null_rows_;
  struct Place {
    std::size_t front;
    Eigen::Index row;  // of the front, in assemble()
  };
  std::vector<Place> places_;         // by row of M
  std::vector<std::size_t> parents_;  // by front; itself where it has none
  std::vector<std::size_t> touched_, open_;
};

}  // namespace virtual_work_dynamics
