#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "motion/stream_identification.h"

namespace virtual_work_dynamics {

/// The latest seconds of one coordinate as blocks, means of some samples each, from which a model
/// is found. Does not allocate once reserve() has been called.
class BlockRecord {
 public:
  /// Blocks that are kept at most; a newer one replaces the oldest. Of slow streams fewer are kept,
  /// as one model is to hold for all of them.
  static constexpr std::size_t kMost = 1536;

  void reserve() { blocks_.resize(kMost); }

  /// Adds a sample to the block that is being filled. A rate that has changed begins another
  /// record, as blocks would be of another length.
  /// @param stamp ns, later than all before   @param position rad or m, unwrapped
  /// @param velocity rad/s or m/s; NaN: not given   @param stretch samples since the latest gap
  /// @param interval s, usual time between samples
  void add(std::int64_t stamp, double position, double velocity, int stretch, double interval);

  /// Begins another stretch of samples: no block goes across its beginning.
  void beginStretch() { filled_ = 0; }

  /// Forgets all blocks.
  void clear();

  /// Forgets all except for so many of the latest blocks.
  void keep(std::size_t latest);

  /// Number of blocks.
  std::size_t count() const { return count_; }
  /// Number of blocks that were completed since the latest copyTo().
  std::size_t fresh() const { return fresh_; }
  /// Samples in each block.
  int samples() const { return samples_; }
  /// Usual time from block to block, s.
  double interval() const { return sample_interval_ * samples_; }

  /// Copies the blocks, oldest first, times in s from the beginning of the record. Allocates only
  /// where `blocks` has less room than kMost.
  void copyTo(std::vector<StreamBlock>& blocks);

 private:
  std::vector<StreamBlock> blocks_;  // a ring
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::size_t fresh_ = 0;
  int samples_ = 0;             // in a block; 0: not known yet
  double sample_interval_ = 0;  // s, when the record began
  std::int64_t start_ = 0;      // ns, of the record

  // The block that is being filled: sums relative to its first sample.
  StreamBlock sum_{0, 0, 0};
  int filled_ = 0;  // samples
  std::int64_t first_stamp_ = 0;
  double first_position_ = 0;
};

}  // namespace virtual_work_dynamics
