#pragma once

#include <cstddef>
#include <vector>

#include "base/aligned_memory.h"
#include "loops/sample_pack.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Rows of a MotionTable in packs, whose results stay arrays until a row is read. Allocates in its
/// constructor only.
class PackedRows {
 public:
  /// What rows have in common.
  struct Common {
    const InverseDynamics& tree;        ///< without closures; must outlive it
    const Load& own_load;               ///< as the tree
    Results usual;                      ///< of samples with full ranks, but for their numbers
    std::vector<std::size_t> group_of;  ///< by closure: its place among a record's conditions
  };
  /// @param pack of the plan. @param capacity most rows
  PackedRows(Common common, const SamplePack& pack, std::size_t capacity);

  /// Computes as many of the rows as there are in whole packs, and returns how many these are.
  /// @param loads one for each row; null: the scene's own
  /// @param computed told for each of these rows whether it has results
  std::size_t compute(const MotionTable& table, std::size_t first, std::size_t count,
                      const Load* loads, SamplePack& pack, std::vector<bool>& computed);
  /// Results of a row that has them; valid until another one is read or computed.
  const Results& read(std::size_t index);

 private:
  void takeMotion(const MotionTable& table, std::size_t first, std::size_t count);
  void computeTree(std::size_t count, const Load* loads);

  Common common_;
  BlockInverseDynamics<double> block_;
  std::size_t width_, coordinates_, rows_, roots_;
  SamplePack::Record record_;
  AlignedMemory memory_;
  double *q_, *qd_, *qdd_, *root_, *effort_, *child_axes_, *root_axes_;  // number by number
  double* records_;                                                      // pack by pack
  std::vector<Wrench> loads_;  // of the scene's applied wrenches, by row, where they are given
  bool loads_given_ = false;
  Results shown_;
};

}  // namespace virtual_work_dynamics
