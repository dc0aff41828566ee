#include "motion/velocity_judge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace virtual_work_dynamics {
namespace {

constexpr double kHorizon = 0.1;  // s
/// Differences of positions that are told from noise, in deviations of a position.
constexpr double kClear = 30;
/// Largest deviation of the ratio from one, and of what is left from the differences themselves.
constexpr double kRatioTolerance = 0.08;
constexpr double kRestTolerance = 0.35;
/// Longest step inside of a comparison, in intervals: nothing is known of the motion in a gap.
constexpr double kLongestStep = 3;

}  // namespace

VelocityJudgement judgeVelocities(const std::vector<StreamBlock>& blocks, double interval,
                                  double noise) {
  VelocityJudgement judgement;
  const auto span =
      static_cast<std::size_t>(std::clamp(std::lround(kHorizon / interval), 4L, 1000L));
  double moved2 = 0;
  double product = 0;
  double integrated2 = 0;
  int count = 0;
  for (std::size_t first = 0; first + span < blocks.size(); first += span / 2) {
    double integral = 0;
    for (std::size_t i = first + 1; i <= first + span; ++i) {
      const double dt = blocks[i].time - blocks[i - 1].time;
      const bool gap = dt > kLongestStep * interval || blocks[i].begins;
      integral += gap ? std::nan("") : 0.5 * dt * (blocks[i].velocity + blocks[i - 1].velocity);
    }
    if (std::isnan(integral)) continue;
    const double moved = blocks[first + span].position - blocks[first].position;
    moved2 += moved * moved;
    product += moved * integral;
    integrated2 += integral * integral;
    ++count;
  }
  if (count == 0 || moved2 < kClear * kClear * noise * noise * count) return judgement;
  judgement.moved = true;
  judgement.ratio = product / moved2;
  // Squares of what is left of the integrals when `ratio` times the differences is taken away.
  const double rest2 = std::max(0.0, integrated2 - judgement.ratio * product);
  judgement.agree = std::abs(judgement.ratio - 1) <= kRatioTolerance &&
                    rest2 <= kRestTolerance * kRestTolerance * moved2;
  return judgement;
}

}  // namespace virtual_work_dynamics
