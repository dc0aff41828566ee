#include "motion/stream_identification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "integrated_noise.h"
#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kInterval = 0.004;
constexpr double kTimeConstant = 0.02;
constexpr double kPositionNoise = 3e-5;

StreamModel identified(const std::vector<StreamBlock>& blocks, const StreamKnowledge& knowledge,
                       double interval = kInterval, int samples = 1) {
  StreamIdentification identification;
  identification.blocks() = blocks;
  identification.start(knowledge, interval, samples, nullptr);
  identification.finish();
  EXPECT_FALSE(identification.running());
  EXPECT_TRUE(std::isfinite(identification.value()));
  return identification.model();
}

IntegratedNoise motionOf(int order) {
  IntegratedNoise motion;
  motion.order = order;
  motion.position_noise = kPositionNoise;
  motion.density = densityFor(kTimeConstant, kPositionNoise * kPositionNoise, order, kInterval);
  return motion;
}

StreamKnowledge knowledgeOf(int order) {
  StreamKnowledge knowledge;
  knowledge.order = order;
  knowledge.stamp_noise = 0;
  knowledge.use_velocities = false;
  return knowledge;
}

// Estimates of a deviation from n samples scatter by 1/sqrt(2 n), here 1.6 %; the time constant is
// known from fewer. Three times as much, and the tolerance of the search.
constexpr std::size_t kBlocks = 2000;
constexpr double kNoiseTolerance = 0.10;
constexpr double kTimeTolerance = 0.15;

TEST(StreamIdentification, FindsNoiseAndDensityOfEachOrder) {
  for (const int order : {3, 4, 5, 6}) {
    const std::vector<StreamBlock> blocks =
        motionOf(order).samples(evenlySpaced(kBlocks, kInterval), 5);
    const StreamModel model = identified(blocks, knowledgeOf(order));
    EXPECT_NEAR(std::sqrt(model.position_variance) / kPositionNoise, 1, kNoiseTolerance) << order;
    EXPECT_NEAR(timeConstant(model, order, kInterval) / kTimeConstant, 1, kTimeTolerance) << order;
    EXPECT_FALSE(model.usesVelocities());
    EXPECT_EQ(model.stamp_variance, 0);
  }
}

TEST(StreamIdentification, FindsTheNoiseOfVelocities) {
  IntegratedNoise motion = motionOf(4);
  for (const double noise : {3e-4, 3e-2}) {
    motion.velocity_noise = noise;
    StreamKnowledge knowledge = knowledgeOf(4);
    knowledge.use_velocities = true;
    std::vector<StreamBlock> blocks = motion.samples(evenlySpaced(kBlocks, kInterval), 6);
    for (std::size_t i = 0; i < blocks.size(); i += 3) blocks[i].velocity = std::nan("");
    const StreamModel model = identified(blocks, knowledge);
    EXPECT_NEAR(std::sqrt(model.velocity_variance) / noise, 1, kNoiseTolerance);
    EXPECT_NEAR(std::sqrt(model.position_variance) / kPositionNoise, 1, kNoiseTolerance);
  }
}

TEST(StreamIdentification, TellsNoiseOfStampsFromNoiseOfPositions) {
  // At speeds up to some rad/s, 0.1 ms are up to ten times the noise of positions.
  IntegratedNoise motion = motionOf(4);
  motion.density *= 1e3;
  motion.stamp_noise = 1e-4;
  StreamKnowledge knowledge = knowledgeOf(4);
  knowledge.stamp_noise = -1;
  const StreamModel model =
      identified(motion.samples(evenlySpaced(kBlocks, kInterval), 7), knowledge);
  EXPECT_NEAR(std::sqrt(model.stamp_variance) / motion.stamp_noise, 1, 2 * kNoiseTolerance);
  motion.stamp_noise = 0;
  const StreamModel exact =
      identified(motion.samples(evenlySpaced(kBlocks, kInterval), 7), knowledge);
  EXPECT_LT(std::sqrt(exact.stamp_variance), 1e-5);
}

TEST(StreamIdentification, OfMeansGivesTheNoiseOfSamples) {
  IntegratedNoise motion = motionOf(4);
  motion.velocity_noise = 1e-3;
  constexpr int kSize = 4;
  const std::vector<StreamBlock> samples =
      motion.samples(evenlySpaced(kSize * kBlocks, kInterval / kSize), 8);
  StreamKnowledge knowledge = knowledgeOf(4);
  knowledge.use_velocities = true;
  const StreamModel model = identified(averaged(samples, kSize), knowledge, kInterval, kSize);
  EXPECT_NEAR(std::sqrt(model.position_variance) / motion.position_noise, 1, kNoiseTolerance);
  EXPECT_NEAR(std::sqrt(model.velocity_variance) / motion.velocity_noise, 1, kNoiseTolerance);
  EXPECT_NEAR(std::pow(model.density / motion.density, 1.0 / 8), 1, kTimeTolerance);
}

TEST(StreamIdentification, KeepsWhatIsKnown) {
  const std::vector<StreamBlock> blocks = motionOf(4).samples(evenlySpaced(400, kInterval), 9);
  const double rounding = 1e-12;  // of logarithms and back
  StreamKnowledge knowledge = knowledgeOf(4);
  knowledge.position_noise = 2e-4;
  EXPECT_NEAR(std::sqrt(identified(blocks, knowledge).position_variance) / 2e-4, 1, rounding);
  knowledge.time_constant = 0.05;
  EXPECT_NEAR(timeConstant(identified(blocks, knowledge), 4, kInterval) / 0.05, 1, rounding);
  knowledge = knowledgeOf(4);
  knowledge.stamp_noise = 1e-3;
  EXPECT_NEAR(std::sqrt(identified(blocks, knowledge).stamp_variance) / 1e-3, 1, rounding);
  // Noise that no sample can be better than.
  knowledge = knowledgeOf(4);
  knowledge.least_position = 10 * kPositionNoise;
  EXPECT_GE(std::sqrt(identified(blocks, knowledge).position_variance),
            10 * kPositionNoise * (1 - rounding));
}

TEST(StreamIdentification, LearnsNothingAcrossGaps) {
  std::vector<StreamBlock> blocks = motionOf(4).samples(evenlySpaced(kBlocks, kInterval), 10);
  const StreamModel whole = identified(blocks, knowledgeOf(4));
  // A jump that no motion of this density could make in the gap.
  for (std::size_t i = kBlocks / 2; i < kBlocks; ++i) {
    blocks[i].time += 0.5;
    blocks[i].position += 1e6;
  }
  const StreamModel parted = identified(blocks, knowledgeOf(4));
  EXPECT_NEAR(parted.position_variance / whole.position_variance, 1, 2 * kNoiseTolerance);
  EXPECT_NEAR(timeConstant(parted, 4, kInterval) / timeConstant(whole, 4, kInterval), 1,
              kTimeTolerance);
}

TEST(StreamIdentification, SlicesGiveTheSameBits) {
  IntegratedNoise motion = motionOf(4);
  motion.velocity_noise = 1e-3;
  motion.stamp_noise = 1e-4;
  StreamKnowledge knowledge;
  StreamIdentification whole;
  whole.blocks() = motion.samples(evenlySpaced(200, kInterval), 11);
  StreamModel guess;
  guess.position_variance = 1e-8;
  guess.density = 1;
  for (const StreamModel* from : {static_cast<const StreamModel*>(nullptr), &std::as_const(guess)})
    for (const int slice : {1, 7, 1000}) {
      StreamIdentification sliced;
      sliced.blocks() = whole.blocks();
      whole.start(knowledge, kInterval, 1, from);
      whole.finish();
      sliced.start(knowledge, kInterval, 1, from);
      int slices = 1;
      while (!sliced.advance(slice)) {
        ASSERT_TRUE(sliced.running());
        ASSERT_LT(++slices, 1000000);
      }
      EXPECT_GT(slices, 10);
      EXPECT_FALSE(sliced.running());
      EXPECT_FALSE(sliced.advance(slice));
      EXPECT_EQ(sliced.model().density, whole.model().density);
      EXPECT_EQ(sliced.model().position_variance, whole.model().position_variance);
      EXPECT_EQ(sliced.model().velocity_variance, whole.model().velocity_variance);
      EXPECT_EQ(sliced.model().stamp_variance, whole.model().stamp_variance);
      EXPECT_EQ(sliced.value(), whole.value());
    }
}

/// Innovations that are judged in a stretch of so many blocks, under these rules.
double judgedOf(std::size_t count, const IdentificationRules& rules) {
  // Two streams whose only difference is the scale by 2: each judged innovation adds 2 log 2.
  const std::vector<StreamBlock> blocks = motionOf(4).samples(evenlySpaced(count, kInterval), 12);
  std::vector<StreamBlock> doubled = blocks;
  for (StreamBlock& block : doubled) block.position *= 2;
  StreamIdentification one, two;
  StreamKnowledge knowledge = knowledgeOf(4);
  knowledge.time_constant = kTimeConstant;
  knowledge.rules = rules;
  one.blocks() = blocks;
  two.blocks() = doubled;
  knowledge.position_noise = kPositionNoise;
  one.start(knowledge, kInterval, 1, nullptr);
  one.finish();
  knowledge.position_noise = 2 * kPositionNoise;
  two.start(knowledge, kInterval, 1, nullptr);
  two.finish();
  // In the mean the squares of innovations are their variances.
  EXPECT_LT(one.value(), 0);
  const double judged = std::round((two.value() - one.value()) / (2 * std::log(2.0)));
  EXPECT_NEAR(two.value() - one.value(), judged * 2 * std::log(2.0), 1e-7);
  return judged;
}

// The likelihood as a number: of white noise about a motion that is known to stand still.
TEST(StreamIdentification, ValueIsMinusTwiceTheLogarithmOfTheLikelihood) {
  const double judged = judgedOf(300, IdentificationRules());
  EXPECT_GT(judged, 290);
  EXPECT_LT(judged, 300);
}

TEST(StreamIdentification, MayLeaveOutWhatAStartIsFittedTo) {
  IdentificationRules rules;
  rules.judge_start = false;
  EXPECT_EQ(judgedOf(300, rules), 225);  // no more than a quarter is left out
  EXPECT_EQ(judgedOf(1000, rules), 1000 - 128);
}

// Of a joint that is slow for its encoder, noise is at its bound, where a simplex collapses.
TEST(StreamIdentification, SearchesAgainWhereThatFindsLikelierModels) {
  constexpr double kQuantum = 1e-3;
  constexpr double kStep = 0.002;
  double gain = 0;
  for (const int order : {4, 5})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      std::mt19937 generator(seed);
      std::normal_distribution<double> noise(0, 0.02);
      std::vector<StreamBlock> blocks;
      for (const double t : evenlySpaced(1000, kStep))
        blocks.push_back({t, kQuantum * std::round(0.3 * std::sin(2 * t + seed) / kQuantum),
                          0.6 * std::cos(2 * t + seed) + noise(generator)});
      StreamKnowledge knowledge;
      knowledge.order = order;
      knowledge.least_position = kQuantum / std::sqrt(12.0);
      double values[2];
      for (const bool again : {false, true}) {
        StreamIdentification identification;
        identification.blocks() = blocks;
        knowledge.rules.search_again = again;
        identification.start(knowledge, kStep, 1, nullptr);
        identification.finish();
        values[again ? 1 : 0] = identification.value();
      }
      EXPECT_LE(values[1], values[0]);
      gain += values[0] - values[1];
    }
  EXPECT_GT(gain, 5);
}

}  // namespace
}  // namespace virtual_work_dynamics
