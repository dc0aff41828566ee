#include "motion/stream_surprise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace virtual_work_dynamics {
namespace {

using Verdict = StreamSurprise::Verdict;

/// How often each verdict was given for white innovations of this deviation.
struct Counts {
  int quicker = 0;
  int noisier = 0;
  int jump = 0;
  int longest_wait = 0;  // samples without a verdict
};

Counts countsOf(double deviation, int samples, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, deviation);
  StreamSurprise surprise;
  Counts counts;
  int wait = 0;
  for (int i = 0; i < samples; ++i) {
    const Verdict verdict = surprise.take(normal(generator)).verdict;
    counts.quicker += verdict == Verdict::kQuicker;
    counts.noisier += verdict == Verdict::kNoisier;
    counts.jump += verdict == Verdict::kJump;
    wait = verdict == Verdict::kNothing ? wait + 1 : 0;
    counts.longest_wait = std::max(counts.longest_wait, wait);
  }
  return counts;
}

TEST(StreamSurprise, IsNothingWhereTheModelHolds) {
  const Counts counts = countsOf(1, 1000000, 1);
  EXPECT_EQ(counts.quicker + counts.noisier + counts.jump, 0);
}

// Some of the verdicts are kQuicker, as successive innovations may have one sign by chance.
TEST(StreamSurprise, IsNoisierWhereTheNoiseIsThreeTimesAsLarge) {
  const Counts counts = countsOf(3, 100000, 2);
  EXPECT_GT(counts.noisier, 3 * counts.quicker);
  EXPECT_EQ(counts.jump, 0);
  EXPECT_LT(counts.longest_wait, 100);
}

TEST(StreamSurprise, ExplainsAtLeastTheMeanSquare) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal(0, 3);
  StreamSurprise surprise;
  for (int i = 0; i < 10000; ++i) {
    const StreamSurprise::Finding finding = surprise.take(normal(generator));
    if (finding.verdict == Verdict::kNothing) {
      EXPECT_EQ(finding.factor, 1);
    } else {
      EXPECT_GE(finding.factor, 6);
    }
  }
}

TEST(StreamSurprise, IsQuickerWhereInnovationsStayOnOneSide) {
  for (const double drift : {3.0, -3.0, 10.0, -100.0}) {
    StreamSurprise surprise;
    StreamSurprise::Finding finding;
    int samples = 0;
    while (finding.verdict == Verdict::kNothing && samples < 100) {
      finding = surprise.take(drift);
      ++samples;
    }
    EXPECT_EQ(finding.verdict, Verdict::kQuicker) << drift;
    EXPECT_LE(samples, 6) << drift;
    EXPECT_EQ(finding.factor, drift * drift) << drift;
  }
}

TEST(StreamSurprise, IsNoisierWhereInnovationsAlternate) {
  StreamSurprise surprise;
  StreamSurprise::Finding finding;
  for (int i = 0; i < 100 && finding.verdict == Verdict::kNothing; ++i)
    finding = surprise.take(i % 2 == 0 ? 100 : -100);
  EXPECT_EQ(finding.verdict, Verdict::kNoisier);
}

TEST(StreamSurprise, IsNothingForOneOutlier) {
  // Among innovations as foreseen on either side, it counts no more than five deviations.
  for (const double outlier : {7.0, 1e3, 1e6, -1e6, 1e300}) {
    StreamSurprise surprise;
    for (int i = 0; i < 100; ++i) {
      const double innovation = i == 50 ? outlier : i % 2 == 0 ? 1 : -1;
      EXPECT_EQ(surprise.take(innovation).verdict, Verdict::kNothing) << outlier << " " << i;
    }
  }
}

TEST(StreamSurprise, IsAJumpForTwoFarAwayOnOneSide) {
  for (const double far : {2e4, -2e4, 1e9}) {
    StreamSurprise surprise;
    for (int i = 0; i < 20; ++i) surprise.take(i % 2 == 0 ? 1 : -1);
    EXPECT_EQ(surprise.take(far).verdict, Verdict::kNothing) << far;
    const StreamSurprise::Finding finding = surprise.take(0.9 * far);
    EXPECT_EQ(finding.verdict, Verdict::kJump) << far;
    EXPECT_EQ(finding.factor, 0.9 * far * (0.9 * far)) << far;
  }
}

TEST(StreamSurprise, IsNoJumpForTwoFarAwayOnEitherSide) {
  StreamSurprise surprise;
  EXPECT_EQ(surprise.take(1e9).verdict, Verdict::kNothing);
  EXPECT_EQ(surprise.take(-1e9).verdict, Verdict::kNoisier);
}

TEST(StreamSurprise, GivesAVerdictOnce) {
  StreamSurprise surprise;
  surprise.take(1e6);
  EXPECT_EQ(surprise.take(1e6).verdict, Verdict::kJump);
  EXPECT_EQ(surprise.take(1e6).verdict, Verdict::kNothing);
}

TEST(StreamSurprise, ForgetsWhenItIsRestarted) {
  StreamSurprise surprise;
  surprise.take(1e6);
  surprise.restart();
  EXPECT_EQ(surprise.take(1e6).verdict, Verdict::kNothing);
}

}  // namespace
}  // namespace virtual_work_dynamics
