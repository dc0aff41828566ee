#include "base/run_time_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <thread>
#include <vector>

namespace virtual_work_dynamics {
namespace {

// Half a bin of 32 to the octave, as the class promises.
constexpr double kResolution = 1.0 / 64;

void expectNear(std::int64_t reported, std::int64_t exact) {
  EXPECT_LE(std::abs(static_cast<double>(reported - exact)),
            kResolution * static_cast<double>(exact))
      << reported << " for " << exact;
}

TEST(RunTimeHistogram, IsZeroWhenNothingWasRecorded) {
  const RunTimeHistogram histogram;
  const RunTimeHistogram::Summary summary = histogram.summary();
  EXPECT_EQ(summary.count, 0u);
  EXPECT_EQ(summary.median_ns, 0);
  EXPECT_EQ(summary.p99_ns, 0);
  EXPECT_EQ(summary.worst_ns, 0);
}

TEST(RunTimeHistogram, ResolvesEveryOctaveAndKeepsTheWorstExactly) {
  RunTimeHistogram histogram;
  for (int bit = 0; bit < 37; ++bit) {
    const std::int64_t octave = std::int64_t{1} << bit;
    // Edges of the octave, of its second and of its last bin, and the middle of a bin.
    for (const std::int64_t ns :
         {octave, octave + octave / 32, octave + octave / 64 + octave / 32,
          octave + octave / 32 - 1, 2 * octave - octave / 32, 2 * octave - 1}) {
      histogram.record(ns);
      const RunTimeHistogram::Summary summary = histogram.takeSummary();
      ASSERT_EQ(summary.count, 1u) << ns;
      EXPECT_EQ(summary.worst_ns, ns);
      expectNear(summary.median_ns, ns);
      expectNear(summary.p99_ns, ns);
    }
  }
}

TEST(RunTimeHistogram, HoldsShortTimesExactly) {
  for (int ns = 0; ns < 64; ++ns) {
    RunTimeHistogram histogram;
    histogram.record(ns);
    histogram.record(ns);
    histogram.record(1000);
    EXPECT_EQ(histogram.summary().median_ns, ns);
  }
}

TEST(RunTimeHistogram, MatchesTheQuantilesOfTheSortedTimes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> decades(0, 11);  // 1 ns to 100 s
  for (const std::size_t count : {1, 2, 3, 99, 100, 101, 199, 200, 201, 5000}) {
    RunTimeHistogram histogram;
    std::vector<std::int64_t> times;
    for (std::size_t i = 0; i < count; ++i) {
      times.push_back(std::llround(std::pow(10.0, decades(random))));
      histogram.record(times.back());
    }
    std::sort(times.begin(), times.end());
    const RunTimeHistogram::Summary summary = histogram.summary();
    SCOPED_TRACE(count);
    EXPECT_EQ(summary.count, count);
    EXPECT_EQ(summary.worst_ns, times.back());
    expectNear(summary.median_ns, times[(count + 1) / 2 - 1]);
    expectNear(summary.p99_ns, times[(99 * count + 99) / 100 - 1]);
  }
}

TEST(RunTimeHistogram, TakesTimesOutOfRangeAsItsEnds) {
  RunTimeHistogram histogram;
  histogram.record(-5);
  histogram.record(std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(histogram.summary().count, 2u);
  EXPECT_EQ(histogram.summary().worst_ns, 0);
  histogram.record(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.summary().count, 3u);
  EXPECT_EQ(histogram.summary().worst_ns, (std::int64_t{1} << 37) - 1);
}

TEST(RunTimeHistogram, StartsANewIntervalOnlyWhenTaken) {
  RunTimeHistogram histogram;
  histogram.record(40);
  histogram.record(50);
  EXPECT_EQ(histogram.summary().count, 2u);
  EXPECT_EQ(histogram.summary().count, 2u);
  EXPECT_EQ(histogram.takeSummary().worst_ns, 50);
  EXPECT_EQ(histogram.summary().count, 0u);
  histogram.record(30);
  const RunTimeHistogram::Summary next = histogram.takeSummary();
  EXPECT_EQ(next.count, 1u);
  EXPECT_EQ(next.worst_ns, 30);
}

TEST(RunTimeHistogram, LosesNothingWhenTakenWhileAnotherThreadRecords) {
  RunTimeHistogram histogram;
  std::atomic<bool> stop{false};
  std::uint64_t records = 0;
  std::thread writer([&] {
    // One bin, so that reader and writer meet in it; every time ends in 7.
    for (; !stop; ++records)
      histogram.record(static_cast<std::int64_t>(98307 + 10 * (records % 200)));
  });
  std::vector<RunTimeHistogram::Summary> intervals;
  while (histogram.summary().count == 0) std::this_thread::yield();
  for (int i = 0; i < 20000; ++i) {
    const RunTimeHistogram::Summary summary = histogram.takeSummary();
    if (summary.count > 0) intervals.push_back(summary);
  }
  stop = true;
  writer.join();
  std::uint64_t count = histogram.summary().count;
  for (const RunTimeHistogram::Summary& summary : intervals) {
    count += summary.count;
    ASSERT_EQ(summary.worst_ns % 10, 7);
    ASSERT_GE(summary.median_ns, 98307 * (1 - kResolution));
    ASSERT_LE(summary.median_ns, summary.p99_ns);
    ASSERT_LE(summary.p99_ns, summary.worst_ns);
    ASSERT_LE(summary.worst_ns, 100297);
  }
  EXPECT_EQ(count, records);
}

}  // namespace
}  // namespace virtual_work_dynamics
