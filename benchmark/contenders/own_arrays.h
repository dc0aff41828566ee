#pragma once

#include <cstddef>
#include <vector>

#include "contenders/contender.h"
#include "virtual_work_dynamics/block.h"

namespace virtual_work_dynamics {

/// Arrays of a block stay in a core's second-level cache: fewer samples for long chains, down to
/// the widest vector's. Counts are odd multiples of the states: see BlockLayout on powers of two.
inline constexpr std::size_t kMostRounds = 63;
inline constexpr std::size_t kCacheBytes = std::size_t(1) << 20;
/// Starting threads takes microseconds: they are for long blocks.
inline constexpr std::size_t kLongerForThreads = 4;

template <typename Real>
std::size_t samplesOf(std::size_t numbers_in_sample, int threads) {
  std::size_t rounds = kMostRounds;
  while (rounds > 1 && rounds * kStates * numbers_in_sample * sizeof(Real) > kCacheBytes) {
    rounds = (rounds - 1) / 2;
  }
  const std::size_t samples = rounds * kStates * static_cast<std::size_t>(threads);
  return threads > 1 ? kLongerForThreads * samples : samples;
}

/// One array of `width` numbers for each sample in the given layout.
template <typename Real>
class Array {
 public:
  Array(BlockLayout layout, std::size_t samples, std::size_t width)
      : layout_(layout), samples_(samples), width_(width), numbers_(samples * width) {}

  Real& at(std::size_t sample, std::size_t number) { return numbers_[place(sample, number)]; }
  Real at(std::size_t sample, std::size_t number) const { return numbers_[place(sample, number)]; }
  std::size_t width() const { return width_; }
  Real* data() { return numbers_.data(); }

 private:
  std::size_t place(std::size_t sample, std::size_t number) const {
    return layout_ == BlockLayout::kRowMajor ? sample * width_ + number
                                             : number * samples_ + sample;
  }

  BlockLayout layout_;
  std::size_t samples_, width_;
  std::vector<Real> numbers_;
};

template <typename Real>
Array<Real> arrayOf(const BenchmarkScene& scene, Eigen::VectorXd Motion::*member,
                    BlockLayout layout, std::size_t samples) {
  Array<Real> array(layout, samples, scene.mechanism.coordinates().size());
  for (std::size_t n = 0; n < samples; ++n) {
    const Eigen::VectorXd& values = scene.motions[n % kStates].*member;
    for (std::size_t i = 0; i < array.width(); ++i) {
      array.at(n, i) = static_cast<Real>(values[static_cast<Eigen::Index>(i)]);
    }
  }
  return array;
}

/// The results of a sample.
template <typename Real>
SampleResults resultsOf(const Array<Real>& effort, const Array<Real>& reactions,
                        std::size_t sample) {
  SampleResults results;
  for (std::size_t i = 0; i < effort.width(); ++i) results.efforts.push_back(effort.at(sample, i));
  for (std::size_t i = 0; i < reactions.width(); ++i) {
    results.reactions.push_back(reactions.at(sample, i));
  }
  return results;
}

}  // namespace virtual_work_dynamics
