#include "motion/shown_noise.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {
namespace {

/// Differences that noise can be told from.
constexpr int kFewestDifferences = 6;
/// Correlation of successive differences of white noise, evenly spaced: sums of products of the
/// binomial coefficients 1, 4, 6, 4, 1 with alternating signs.
constexpr double kCorrelation = -56.0 / 70;
/// Square of a difference that is not scaled, over that of noiseDifference().
constexpr double kOfMotion = 70;

}  // namespace

ShownNoise::ShownNoise() : least_(leastNoise(steps_.step(), 0)) {}

void ShownNoise::restart() {
  count_ = 0;
  squares_ = products_ = 0;
}

void ShownNoise::takeStep(double oldest, double middle, double newest) {
  steps_.take(oldest, middle, newest);
  least_ = leastNoise(steps_.step(), newest);
}

void ShownNoise::takeDifference(const std::array<double, kDifferenced>& times,
                                const std::array<double, kDifferenced>& positions) {
  const double difference = noiseDifference(times, positions);
  if (count_ > 0) {
    squares_ += (difference * difference - squares_) / count_;
    products_ += (difference * latest_ - products_) / count_;
  }
  latest_ = difference;
  ++count_;
}

bool ShownNoise::ofMotion() const {
  // Products of differences that follow each other are negative in the mean where noise is white,
  // and as large as the squares where the motion makes them.
  return count_ < 2 || products_ > squares_ / 2;
}

double ShownNoise::deviation() const {
  // A model cannot follow what the motion does between samples that are far apart.
  if (count_ > 1 && ofMotion()) return std::sqrt(kOfMotion * squares_);
  if (count_ < kFewestDifferences) return 0;
  return std::sqrt(std::max(0.0, (squares_ - products_) / (1 - kCorrelation)));
}

}  // namespace virtual_work_dynamics
