#include "loops/residuals.h"

#include "loops/compiled_loops.h"
#include "scene/input_checks.h"

namespace virtual_work_dynamics {

static_assert(sizeof(ClosureResidual) == 3 * sizeof(double), "plain numbers");

LoopResiduals::LoopResiduals(const Mechanism& mechanism, const LoopKinematics& kinematics,
                             double length)
    : kernel_(&loopKernelFor(chosenInstructionSet()).one) {
  for (int i = 0; i < static_cast<int>(mechanism.coordinates().size()); ++i) {
    scales_.push_back(scaleOf(mechanism.unitOf(i), length));
  }
  for (std::size_t s = 0; s < kinematics.sets(); ++s) {
    lengths_.push_back(kinematics.lengthsOf(s));
  }
  view_ = {kinematics.shapesOfRows(),
           lengths_.data(),
           static_cast<int>(lengths_.size()),
           1 / length,
           scales_.data(),
           static_cast<int>(scales_.size())};
}

void LoopResiduals::find(LoopKinematics& kinematics, const Motion& motion,
                         std::vector<ClosureResidual>& plain,
                         std::vector<ClosureResidual>& relative) const {
  kinematics.setMotion(motion);
  if (plain.empty()) return;
  kernel_->residuals(view_, {{kinematics.phi().data(), kinematics.rates().data(),
                              kinematics.accelerations().data()},
                             motion.qd.data(),
                             motion.qdd.data(),
                             &plain.front().position,
                             &relative.front().position});
}

ClosedLoopDynamics::Residuals ClosedLoopDynamics::residualsOf(const Motion& motion,
                                                              Workspace& workspace) const {
  LoopSolvers& solvers = workspace.solversOf(*impl_);
  requireLengths(motion, coordinates());
  requireOrientations(motion, impl_->mechanism.orientations());
  solvers.kinematics.setOrientations(motion.orientations);
  solvers.kinematics.setPosition(motion.q);
  const std::vector<ClosureResidual> none(solvers.kinematics.sets());
  Residuals found{none, none};
  solvers.residuals.find(solvers.kinematics, impl_->static_motion ? Motion(coordinates()) : motion,
                         found.plain, found.relative);
  return found;
}

}  // namespace virtual_work_dynamics
