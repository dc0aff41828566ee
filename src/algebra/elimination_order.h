#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace virtual_work_dynamics {

/// Rows of a matrix that have entries in the same few columns.
struct RowBlock {
  Eigen::Index rows;
  std::vector<int> columns;  ///< each once
  std::vector<int> zeros;    ///< those of the rows, ascending, that have no entries in any matrix
};

/// One step of an elimination by blocks: the rows it takes in, and the columns that have no entry
/// outside of these rows and so can be eliminated here. The rows that remain have entries in the
/// other columns of the front only; the one later front that has this one as a child takes them in.
struct Front {
  std::vector<int> pivots;            ///< columns eliminated here
  std::vector<int> rest;              ///< its other columns
  std::vector<std::size_t> blocks;    ///< blocks whose rows it takes in
  std::vector<std::size_t> children;  ///< earlier fronts whose remaining rows it takes in
};

/// Fronts in the order of elimination: the next column is the one whose elimination couples the
/// fewest columns. Every block of several columns starts with a front of its own, so that dependent
/// rows within a block are found there; a block of one column belongs to the front that eliminates
/// the column. Where one front of all blocks and columns costs clearly less, it is the only one.
std::vector<Front> eliminationOrder(const std::vector<RowBlock>& blocks, int columns);

}  // namespace virtual_work_dynamics
