#include "loops/forces.h"
#include "loops/gear_conditions.h"

namespace virtual_work_dynamics {

// The flank that bears is that of the solution.
void LoopForces::setTeeth(State& state) const {
  for (const std::size_t local : state.touched_closures) {
    const std::size_t c = group_.closures[local];
    if (!kinematics_.closure(c).traits().meshes()) continue;
    const Eigen::Index tooth = unknowns_.of_sets[local].first;
    state.closures[local] = static_cast<const GearConditions&>(kinematics_.closure(c))
                                .wrenchOf(entries_[local].units[0] * state.x[tooth],
                                          solution_.x[tooth] < 0, kinematics_.frames(c));
  }
}

}  // namespace virtual_work_dynamics
