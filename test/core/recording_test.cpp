#include "motion/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "integrated_noise.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kInterval = 0.004;
constexpr double kNoise = 3e-5;
constexpr double kTimeConstant = 0.02;

/// A stream of a motion whose derivative of this order is white noise.
RecordedStream streamOf(int order, const std::vector<double>& times) {
  IntegratedNoise motion;
  motion.order = order;
  motion.position_noise = kNoise;
  motion.density = densityFor(kTimeConstant, kNoise * kNoise, order, kInterval);
  RecordedStream stream;
  for (const StreamBlock& sample : motion.samples(times, 3))
    stream.positions.push_back(sample.position);
  return stream;
}

TEST(RecordingAccuracy, ChoosesTheOrderOfTheMotion) {
  const std::vector<double> times = evenlySpaced(6000, kInterval);
  std::vector<RecordedStream> streams;
  for (int order = 3; order <= kHighestOrder; ++order) streams.push_back(streamOf(order, times));
  Recording recording(times, streams, CompletionSettings());
  std::size_t models = 0;
  recording.identify([&](std::size_t more) { models += more; });
  EXPECT_EQ(models, Recording::kModels * streams.size());
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const int order = static_cast<int>(i) + 3;
    EXPECT_EQ(recording.stream(i).knowledge.order, order);
    EXPECT_NEAR(recording.quality(i).position_noise / kNoise, 1, 0.1) << order;
    EXPECT_NEAR(recording.quality(i).bandwidth * 6.283185307179586 * kTimeConstant, 1, 0.15)
        << order;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
