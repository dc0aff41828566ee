#include "motion/block_record.h"

#include <algorithm>

#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {
namespace {

/// Time that the blocks of slow streams go back, s, but so many blocks of any.
constexpr double kLongest = 6;
constexpr std::size_t kFewestKept = 768;
/// Samples before the time between them is known well enough to size the blocks.
constexpr int kIntervalSamples = 12;
/// Factor between intervals that are of one rate.
constexpr double kOneRate = 1.5;

}  // namespace

void BlockRecord::add(std::int64_t stamp, double position, double velocity, int stretch,
                      double interval) {
  if (samples_ == 0) {
    if (stretch < kIntervalSamples) return;
    samples_ = blockSize(kBlockTime, interval);
    sample_interval_ = interval;
    start_ = stamp;
  }
  if (interval > kOneRate * sample_interval_ || interval < sample_interval_ / kOneRate) {
    samples_ = 0;
    clear();
    return;
  }
  if (filled_ == 0) {
    first_stamp_ = stamp;
    first_position_ = position;
    sum_ = {0, 0, 0};
  }
  sum_.time += secondsBetween(first_stamp_, stamp);
  sum_.position += position - first_position_;
  sum_.velocity += velocity;
  if (++filled_ < samples_) return;
  blocks_[next_] = {secondsBetween(start_, first_stamp_) + sum_.time / samples_,
                    first_position_ + sum_.position / samples_, sum_.velocity / samples_};
  next_ = (next_ + 1) % blocks_.size();
  const auto within = static_cast<std::size_t>(kLongest / this->interval());
  count_ = std::min({count_ + 1, blocks_.size(), std::max(within, kFewestKept)});
  ++fresh_;
  filled_ = 0;
}

void BlockRecord::clear() {
  filled_ = 0;
  count_ = 0;
  fresh_ = 0;
}

void BlockRecord::keep(std::size_t latest) {
  count_ = std::min(count_, latest);
}

void BlockRecord::copyTo(std::vector<StreamBlock>& blocks) {
  blocks.clear();
  const std::size_t oldest = (next_ + blocks_.size() - count_) % blocks_.size();
  for (std::size_t i = 0; i < count_; ++i) blocks.push_back(blocks_[(oldest + i) % blocks_.size()]);
  fresh_ = 0;
}

}  // namespace virtual_work_dynamics
