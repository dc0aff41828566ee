#pragma once

#include <cstddef>
#include <vector>

#include "algebra/elimination_order.h"
#include "algebra/kernel/front_kernel.h"

namespace virtual_work_dynamics {

/// Where the fronts of a MultifrontalQr have their rows, columns and numbers, for matrices of some
/// of the columns. Matrices side by side share it. Allocates in its constructor only.
class FrontLayout {
 public:
  /// All columns are part of the matrix.
  FrontLayout(const std::vector<RowBlock>& blocks, int columns);
  FrontLayout(const FrontLayout&) = delete;  // the view points into it
  FrontLayout(FrontLayout&&) = default;

  /// Makes the columns with a true entry those of the matrix.
  void setPresent(const std::vector<bool>& present);
  const std::vector<bool>& present() const { return present_; }
  /// How many columns are.
  int presentColumns() const { return present_columns_; }

  const FrontsView& view() const { return view_; }
  const std::vector<RowBlock>& blocks() const { return blocks_; }
  const std::vector<Front>& fronts() const { return fronts_; }
  std::size_t rows() const { return places_of_rows_.size(); }
  /// The first row of a block; rows() for one more than there are.
  int firstOf(std::size_t block) const { return first_[block]; }
  /// The front that takes in a row of the matrix, and as which of its rows; front -1 where the row
  /// has no entries in any matrix.
  struct RowPlace {
    int front, row;
  };
  /// How many rows of the matrix can have entries.
  std::size_t filledRows() const;
  const RowPlace& placeOf(std::size_t row) const { return places_of_rows_[row]; }

  /// How long the arrays of a FrontsMemory are, whatever columns are present.
  std::size_t numbers() const { return most_numbers_; }
  std::size_t stairs() const { return most_stairs_; }
  /// How many of their numbers are in use, the first ones.
  std::size_t usedNumbers() const { return numbers_; }
  std::size_t usedStairs() const { return stairs_; }

 private:
  void arrange(bool whatever = false);
  void addBlock(std::size_t block, const std::vector<int>& columns);
  std::size_t deal(std::size_t count);

  std::vector<RowBlock> blocks_;
  std::vector<Front> fronts_;
  std::vector<int> first_;
  std::vector<RowPlace> places_of_rows_;
  std::vector<bool> present_;
  int present_columns_ = 0;
  std::size_t numbers_ = 0, stairs_ = 0;
  std::size_t most_numbers_ = 0, most_stairs_ = 0;

  // What view_ points to.
  std::vector<FrontShape> shapes_;
  std::vector<BlockRows> block_rows_;
  std::vector<BlockColumn> block_columns_;
  std::vector<int> row_order_;      // of all blocks, see BlockRows::order
  std::vector<int> orders_, kept_;  // by block: where its order begins, and its rows with entries
  std::vector<ChildRows> children_;
  std::vector<int> places_, columns_;
  std::vector<int> local_;      // of a front being arranged: its column for a column of the matrix
  std::vector<int> remaining_;  // by front: most rows that it hands on
  FrontsView view_{};
};

}  // namespace virtual_work_dynamics
