#pragma once

#include <cstddef>

#include "virtual_work_dynamics/instruction_set.h"

namespace virtual_work_dynamics {

// The numbers of a MultifrontalQr, compiled once for each instruction set behind plain pointers,
// under the rules of tree/kernel/kernel.h: for one matrix, or for a pack of matrices of the same
// blocks side by side.

/// A column of a block that is part of the matrix.
struct BlockColumn {
  int from;    ///< which of the block's columns
  int to;      ///< which of the front's columns
  int column;  ///< of the matrix
};

/// A block that a front takes in.
struct BlockRows {
  int block;
  int rows;                        ///< that can have entries
  int height;                      ///< number of all its rows
  int order;                       ///< in FrontsView::row_order: the former, then the others
  int first;                       ///< its first row in the matrix
  int columns_begin, columns_end;  ///< of FrontsView::block_columns
};

/// An earlier front whose remaining rows a front takes in.
struct ChildRows {
  int front;
  int places;  ///< in FrontsView::places: the columns here of its columns after the pivots
};

/// A front as kernels see it, with columns that are part of the matrix only. Its numbers lie in the
/// memory of a factorization, each place for one number or one pack.
struct FrontShape {
  int most_rows;  ///< whole chunks of kRowChunk
  int pivots;     ///< its first columns, eliminated here
  int width;      ///< number of its columns
  int depth;      ///< most reflections
  int columns;    ///< in FrontsView::columns: its columns' places in the matrix
  int stairs;     ///< in the stairs of a factorization: the first column of each step's row
  int blocks_begin, blocks_end;      ///< of FrontsView::blocks
  int children_begin, children_end;  ///< of FrontsView::children
  int parent;                        ///< itself where it has none
  // Places of most_rows x width entries, which become R, of most_rows x depth reflections, both by
  // columns, of the reflections' factors, of the reciprocal diagonal, and of a vector with an entry
  // for each row.
  std::size_t entries, reflections, factors, reciprocals, z;
};

/// Rows of fronts are filled up to multiples of this, so that kernels take several at a time.
constexpr int kRowChunk = 4;

struct FrontsView {
  const FrontShape* fronts;
  const BlockRows* blocks;
  const BlockColumn* block_columns;
  const int* row_order;
  const ChildRows* children;
  const int* places;
  const int* columns;
  int front_count, column_count;
  // Places of vectors with an entry for each column.
  std::size_t lengths, sums, solution;
};

/// What a factorization finds out about a front; in a pack, for all matrices alike.
struct FrontState {
  int rows;       ///< of its blocks and of its children's remaining rows
  int steps;      ///< its first rows, which are those of R or are handed on
  int reflected;  ///< how many steps reflect, the first ones
  int in_parent;  ///< where its remaining rows begin in the next front
};

/// A factorization, whose memory holds everything aligned to kVectorAlignment.
struct FrontsMemory {
  double* numbers;
  FrontState* states;  ///< by front
  int* stairs;
};

enum class Factorized {
  kWhole,      ///< the columns are independent
  kDependent,  ///< those of a matrix are dependent, or too short to tell
  kDivided     ///< rounding leaves different rows of the matrices of a pack
};

/// Functions for one matrix, or for a pack of them: neighbouring numbers then belong to
/// neighbouring matrices.
struct FrontFunctions {
  /// @param entries of each block, by columns
  /// @param size see MultifrontalQr::factorize()
  /// @param condition set where the result is kWhole
  Factorized (*factorize)(const FrontsView&, const double* const* entries, double size,
                          const FrontsMemory&, double* condition);
  /// As those of MultifrontalQr; absent columns have no entry of R and keep their entries of u.
  void (*leastNorm)(const FrontsView&, const FrontsMemory&, const double* b, double* x);
  void (*leastSquares)(const FrontsView&, const FrontsMemory&, const double* r, double* u);
  /// @param front that takes in the row, as its row `row`
  void (*nullSquare)(const FrontsView&, const FrontsMemory&, int front, int row, double* square);
  /// Multiplies the z of a front by its reflections, the last one first.
  void (*reflectBack)(const FrontsView&, const FrontsMemory&, int front);
};

struct FrontKernel {
  int width;  ///< matrices of a pack
  FrontFunctions one, pack;
};

// Null where the compiler cannot make one.
const FrontKernel* baselineFronts();
const FrontKernel* avx2Fronts();
const FrontKernel* avx512Fronts();

/// @throws Error when the instruction set is not supported.
const FrontKernel& frontKernelFor(InstructionSet instruction_set);

}  // namespace virtual_work_dynamics
