#include "dynamics/independent_coordinates.h"

#include <algorithm>
#include <string>

#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

namespace {

std::vector<bool> withFreePositions(const Mechanism& mechanism, const ClosedLoopDynamics& dynamics,
                                    const std::vector<bool>& rates) {
  const std::vector<std::string>& names = mechanism.coordinateNames();
  Given given;
  given.coordinates = rates;
  for (;;) {
    const std::vector<std::string> open = dynamics.judge(given).undetermined;
    if (open.empty()) return given.coordinates;
    const auto place = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    const auto preferred = std::find_if(open.begin(), open.end(), [&](const std::string& name) {
      return dynamics.given().coordinates[place(name)];
    });
    given.coordinates[place(preferred == open.end() ? open.front() : *preferred)] = true;
  }
}

}  // namespace

std::vector<bool> independentCoordinates(const ClosedLoopDynamics& dynamics) {
  ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
  std::vector<bool> given(dynamics.actuated().size(), true);
  for (const bool preferred : {false, true}) {
    for (std::size_t i = given.size(); i-- > 0;) {
      if (dynamics.given().coordinates[i] != preferred) continue;
      // At rest the rates are found if and only if what is not given is determined.
      given[i] = false;
      Motion motion(dynamics.coordinates());
      motion.q = dynamics.assembly();
      given[i] = !dynamics.complete(motion, given, workspace);
    }
  }
  return given;
}

IndependentCoordinates independentCoordinates(const Mechanism& mechanism,
                                              const std::optional<ClosedLoopDynamics>& dynamics,
                                              bool have_positions) {
  if (!dynamics) {
    const std::vector<bool> all(mechanism.coordinates().size(), true);
    return {all, all};
  }
  const std::vector<bool> rates = independentCoordinates(*dynamics);
  if (have_positions) return {rates, rates};
  return {withFreePositions(mechanism, *dynamics, rates), rates};
}

}  // namespace virtual_work_dynamics
