#include "loops/forces.h"

namespace virtual_work_dynamics {

// The flank that bears is that of the solution.
void LoopForces::setTeeth(State& state) const {
  for (const std::size_t local : state.touched_closures) {
    const std::size_t c = group_.closures[local];
    if (!kinematics_.closure(c).traits().meshes()) continue;
    const Eigen::Index tooth = unknowns_.of_sets[local].first;
    kernel_->takeFlank(kinematics_.closure(c).shape(), entries_[local].units.data(),
                       &state.x[tooth], &solution_.x[tooth], kinematics_.frames(c).R_P.data(),
                       state.closures[local].force.data());
  }
}

// Whether another flank bears some teeth after a choice than before.
bool LoopForces::turnsFlank(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const {
  if (kinematics_.meshing().empty()) return false;
  for (std::size_t local = 0; local < group_.closures.size(); ++local) {
    if (!kinematics_.closure(group_.closures[local]).traits().meshes()) continue;
    const Eigen::Index tooth = unknowns_.of_sets[local].first;
    if ((before[tooth] < 0) != (after[tooth] < 0)) return true;
  }
  return false;
}

}  // namespace virtual_work_dynamics
