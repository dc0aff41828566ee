#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace virtual_work_dynamics {

/// Distribution of run times, 1 ns to 137 s, in a fixed number of bins: every nanosecond up to 63,
/// then 32 bins to an octave. Quantiles are off by at most 1/64 (1.6 %) of their value; the worst
/// time is exact. One thread records while another one reads; neither waits for the other nor
/// allocates.
class RunTimeHistogram {
 public:
  /// The run times recorded in an interval; zeros when there were none.
  struct Summary {
    std::uint64_t count = 0;
    std::int64_t median_ns = 0;
    std::int64_t p99_ns = 0;
    std::int64_t worst_ns = 0;
  };

  RunTimeHistogram();

  /// Adds one run time; only one thread may call it. Times below 0 count as 0, times above
  /// 2^37 - 1 ns as that number.
  void record(std::int64_t ns);

  /// Summarizes the interval so far; any thread may call it. A quantile is the smallest recorded
  /// time that at least that share of all recorded times does not exceed.
  Summary summary() const;

  /// Summarizes the interval like summary() and starts a new one; one thread at a time may call it.
  /// A time recorded meanwhile belongs to exactly one of the two intervals.
  Summary takeSummary();

 private:
  static constexpr int kSubBits = 5;  // 2^5 bins an octave
  static constexpr int kRangeBits = 37;
  static constexpr int kBins = (kRangeBits - kSubBits + 1) << kSubBits;
  // A bin is one word, so that a record is one atomic step. The bits above kOffsetBits are the
  // count, the others how far the longest time in the bin lies above the bin's lower edge.
  static constexpr int kOffsetBits = kRangeBits - kSubBits - 1;

  using Words = std::array<std::uint64_t, kBins>;
  static Summary summarize(const Words& words);

  std::array<std::atomic<std::uint64_t>, kBins> bins_;
};

}  // namespace virtual_work_dynamics
