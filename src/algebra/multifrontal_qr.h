#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "algebra/elimination_order.h"

namespace virtual_work_dynamics {

/// Orthogonal factorisation M = Q R of a matrix of row blocks that couple few columns each, such as
/// the conditions of many loops, for M u = r and, in least norm, M^T x = b. The cost grows with the
/// number of blocks, not with its cube. Each front pivots among its own columns only, so that it
/// tells full column rank and not what the rank else is: RankFactorization does. Nothing after
/// construction allocates.
class MultifrontalQr {
 public:
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  MultifrontalQr(const std::vector<RowBlock>& blocks, int columns);

  Eigen::Index rows() const { return rows_; }
  Eigen::Index columns() const { return columns_; }
  /// First row of a block; rows() behind the last one.
  Eigen::Index firstOf(std::size_t block) const { return first_[block]; }
  std::size_t blocks() const { return blocks_.size(); }
  /// The entries of a block, to be filled before factorize(): its rows x its columns.
  Eigen::MatrixXd& entriesOf(std::size_t block) { return entries_[block]; }
  const Eigen::MatrixXd& entriesOf(std::size_t block) const { return entries_[block]; }
  const std::vector<int>& columnsOf(std::size_t block) const { return blocks_[block].columns; }

  /// Columns that are part of M, one entry each; the others count as absent. At first all are.
  void setPresent(const std::vector<bool>& present);

  /// False when the columns are dependent, or so close to it that the condition number may be above
  /// `worst_condition`; then there is no factorisation.
  bool factorize(double worst_condition);
  /// A condition number up to which the rank is full without a doubt: far from the tolerance of the
  /// rank, and low enough for rounding to stay far below 1e-8 of a null vector.
  static double sureCondition(double rank_tolerance);
  /// Of M, estimated: the longest column times an estimate of the norm of the inverse of R.
  double condition() const { return condition_; }

  /// The x of least norm with M^T x = b; b has an entry for each column.
  void leastNorm(const Vector& b, Eigen::Ref<Eigen::VectorXd> x);
  /// The u for which |M u - r| is least; zero for absent columns.
  void leastSquares(const Vector& r, Eigen::Ref<Eigen::VectorXd> u);

  /// An orthonormal basis of the x with M^T x = 0.
  std::size_t nullity() const { return null_rows_.size(); }
  /// Sets those entries of x that belong to the blocks named in touched(); the others of the vector
  /// are zero.
  void nullVector(std::size_t i, Eigen::Ref<Eigen::VectorXd> x);
  const std::vector<std::size_t>& touched() const { return touched_; }

 private:
  // A front's rows: pivots, then what is left for the next front, then what has no entries any
  // more.
  struct Work {
    Eigen::MatrixXd F;                              // R above, reflections below
    Eigen::VectorXd factors;                        // of the reflections
    Eigen::VectorXd z;                              // a vector of its rows
    std::vector<int> order;                         // columns: pivots, as chosen, then the rest
    std::vector<Eigen::Index> stairs;               // column of each reflection
    std::vector<std::vector<Eigen::Index>> places;  // by block, then by child: of their columns
    Eigen::Index rows = 0, present = 0, steps = 0;  // present: pivots that are part of M
  };
  struct NullRow {
    std::size_t front;
    Eigen::Index row;
  };

  void assemble(std::size_t f);
  bool eliminate(std::size_t f);
  void compress(std::size_t f);
  void estimateCondition();
  static void reflect(Work& work, Eigen::Index step, Eigen::Index column, Eigen::Index last);
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
  Eigen::VectorXd lengths_;  // of columns, squared
  double longest_ = 0, condition_ = 1;
  Eigen::VectorXd sums_, solution_;  // by column
  std::vector<NullRow> null_rows_;
  std::vector<std::size_t> touched_, open_;
};

}  // namespace virtual_work_dynamics
