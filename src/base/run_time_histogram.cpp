#include "base/run_time_histogram.h"

#include <algorithm>

namespace virtual_work_dynamics {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

/// The base-2 logarithm of the width of the bins in a value's octave.
int widthBits(std::uint64_t value, int sub_bits) {
  if (value >> (sub_bits + 1) == 0) return 0;
  return 63 - __builtin_clzll(value) - sub_bits;
}

}  // namespace

RunTimeHistogram::RunTimeHistogram() {
  for (auto& bin : bins_) bin.store(0, kRelaxed);
}

void RunTimeHistogram::record(std::int64_t ns) {
  constexpr std::int64_t longest = (std::int64_t{1} << kRangeBits) - 1;
  const auto value = static_cast<std::uint64_t>(std::min(std::max<std::int64_t>(ns, 0), longest));
  const int width = widthBits(value, kSubBits);
  const auto index = (static_cast<std::uint64_t>(width) << kSubBits) + (value >> width);
  const std::uint64_t offset = value & ((std::uint64_t{1} << width) - 1);

  constexpr std::uint64_t offset_mask = (std::uint64_t{1} << kOffsetBits) - 1;
  constexpr std::uint64_t one = std::uint64_t{1} << kOffsetBits;
  std::atomic<std::uint64_t>& bin = bins_[index];
  std::uint64_t before = bin.load(kRelaxed);
  std::uint64_t after = 0;
  do {
    // A full count stays full; it does not start again from zero.
    const std::uint64_t count =
        before < ~offset_mask ? (before & ~offset_mask) + one : ~offset_mask;
    after = count | std::max(before & offset_mask, offset);
  } while (!bin.compare_exchange_weak(before, after, kRelaxed));
}

RunTimeHistogram::Summary RunTimeHistogram::summary() const {
  Words words;
  for (int i = 0; i < kBins; ++i) words[i] = bins_[i].load(kRelaxed);
  return summarize(words);
}

RunTimeHistogram::Summary RunTimeHistogram::takeSummary() {
  Words words;
  for (int i = 0; i < kBins; ++i) words[i] = bins_[i].exchange(0, kRelaxed);
  return summarize(words);
}

RunTimeHistogram::Summary RunTimeHistogram::summarize(const Words& words) {
  constexpr std::uint64_t offset_mask = (std::uint64_t{1} << kOffsetBits) - 1;
  Summary summary;
  for (const std::uint64_t word : words) summary.count += word >> kOffsetBits;

  const std::uint64_t median_rank = summary.count - summary.count / 2;
  const std::uint64_t p99_rank = summary.count - summary.count / 100;
  std::uint64_t below = 0;
  for (int i = 0; i < kBins; ++i) {
    const std::uint64_t count = words[i] >> kOffsetBits;
    if (count == 0) continue;
    const int width = std::max(0, (i >> kSubBits) - 1);
    const std::int64_t edge = std::int64_t{i - (width << kSubBits)} << width;
    const auto longest = edge + static_cast<std::int64_t>(words[i] & offset_mask);
    const std::int64_t middle = std::min(edge + ((std::int64_t{1} << width) >> 1), longest);
    if (below < median_rank && median_rank <= below + count) summary.median_ns = middle;
    if (below < p99_rank && p99_rank <= below + count) summary.p99_ns = middle;
    summary.worst_ns = longest;
    below += count;
  }
  return summary;
}

}  // namespace virtual_work_dynamics
