#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace virtual_work_dynamics {

/// Rows of a matrix that have entries in the same few columns.
struct RowBlock {
  Eigen::Index rows;
  std::vector<int> columns;  ///< each once
};

/// One step of an elimination by blocks: the rows it takes in, and the columns that have no entry
/// outside of these and so can be eliminated there. What is left of its rows has entries in the
/// rest of its columns only, and goes to the one later front that lists it.
struct Front {
  std::vector<int> pivots;            ///< columns eliminated here
  std::vector<int> rest;              ///< its other columns
  std::vector<std::size_t> blocks;    ///< whose rows it takes in
  std::vector<std::size_t> children;  ///< earlier fronts, whose remaining rows it takes in
};

/// Fronts in the order of elimination, by the least number of columns that each step couples. Every
/// block of several columns starts with a front of its own, so that rows of it which say the same
/// are found where they are; a column of its own goes where the column is eliminated.
std::vector<Front> eliminationOrder(const std::vector<RowBlock>& blocks, int columns);

}  // namespace virtual_work_dynamics
