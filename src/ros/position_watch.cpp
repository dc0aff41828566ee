#include "ros/position_watch.h"

#include <cmath>
#include <limits>

#include "robot/unit_doubts.h"

namespace virtual_work_dynamics {

PositionWatch::PositionWatch(const Mechanism& mechanism) : mechanism_(mechanism) {
  for (const int joint : mechanism.coordinates())
    largest_.push_back(largestPosition(mechanism.joint(joint)));
}

std::optional<std::string> PositionWatch::take(const JointSample& sample) {
  for (int i = 0; i < sample.count; ++i) {
    const auto coordinate = static_cast<std::size_t>(sample.coordinates[i]);
    if (coordinate >= largest_.size()) continue;  // a length
    if (std::abs(sample.q[i]) <= largest_[coordinate]) continue;
    largest_[coordinate] = std::numeric_limits<double>::infinity();
    return positionQuestion(mechanism_.joint(mechanism_.coordinates()[coordinate]), sample.q[i]);
  }
  return std::nullopt;
}

}  // namespace virtual_work_dynamics
