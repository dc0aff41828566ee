#include "dynamics/covariance_sizes.h"

#include <string>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

void requireSizes(const Mechanism& mechanism, std::size_t wrenches,
                  const MotionCovariance& covariance) {
  const auto require = [](std::size_t size, std::size_t expected, const char* what) {
    if (size == expected) return;
    throw MotionError("covariance: " + std::to_string(size) +
                      " matrices are given, the mechanism has " + std::to_string(expected) + what);
  };
  require(covariance.coordinates.size(), mechanism.coordinates().size(), " coordinates");
  if (covariance.root_link < 0 ||
      static_cast<std::size_t>(covariance.root_link) >= mechanism.links().size()) {
    throw MotionError("covariance: link " + std::to_string(covariance.root_link) +
                      " is to tell how the root moves, the mechanism has " +
                      std::to_string(mechanism.links().size()) + " links");
  }
  if (!covariance.turns.empty())
    require(covariance.turns.size(), mechanism.orientations(), " joints that turn freely");
  if (covariance.wrenches.empty() || covariance.wrenches.size() == wrenches) return;
  throw MotionError("covariance: it has " + std::to_string(covariance.wrenches.size()) +
                    " wrenches, the scene has " + std::to_string(wrenches) + " applied wrenches");
}

}  // namespace virtual_work_dynamics
