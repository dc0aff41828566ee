#include "dynamics/effort_groups.h"

namespace virtual_work_dynamics {

EffortGroups::EffortGroups(const Dynamics& dynamics) {
  const std::vector<bool>& coordinates = dynamics.actuated();  // closures stand behind them
  const std::size_t first_coupling = dynamics.effortNames().size() - dynamics.couplings();
  for (std::size_t i = 0; i < dynamics.effortNames().size(); ++i) {
    const bool is_actuated = i >= coordinates.size() || coordinates[i];
    (i >= first_coupling       ? couplings
     : dynamics.residuals()[i] ? residuals
     : is_actuated             ? actuated
                               : passive)
        .push_back(dynamics.effortNames()[i]);
  }
}

}  // namespace virtual_work_dynamics
