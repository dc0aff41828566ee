#include "motion/stream_surprise.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {
namespace {

/// Mean square of innovations that the model cannot have foreseen, the samples that the mean goes
/// over, and the largest innovation that counts in it, so that one sample alone is no surprise.
constexpr double kSurprising = 6;
constexpr double kSamples = 6;
constexpr double kLargest = 5;
/// Innovations of which two in a row are of no motion that a model could follow.
constexpr double kJump = 1e4;
/// Part of the mean square that products of successive innovations make when it is the motion that
/// is quicker; those of noise alternate.
constexpr double kOneWay = 0.3;

double limited(double innovation) {
  return std::clamp(innovation, -kLargest, kLargest);
}

}  // namespace

StreamSurprise::Finding StreamSurprise::take(double innovation) {
  const double square = limited(innovation) * limited(innovation);
  const double product = limited(innovation) * limited(previous_);
  // What two samples in a row say is no outlier.
  const bool same_side = innovation * previous_ > 0;
  const double seen_twice = same_side ? std::min(std::abs(innovation), std::abs(previous_)) : 0;
  square_ += (square - square_) / kSamples;
  product_ += (product - product_) / kSamples;
  previous_ = innovation;
  Finding finding;
  if (seen_twice > kJump) {
    finding = {Verdict::kJump, seen_twice * seen_twice};
  } else if (square_ < kSurprising) {
    return finding;
  } else if (product_ > kOneWay * square_) {
    finding = {Verdict::kQuicker, std::max(square_, seen_twice * seen_twice)};
  } else {
    finding = {Verdict::kNoisier, square_};
  }
  restart();
  return finding;
}

void StreamSurprise::restart() {
  square_ = 1;
  product_ = 0;
  previous_ = 0;
}

}  // namespace virtual_work_dynamics
