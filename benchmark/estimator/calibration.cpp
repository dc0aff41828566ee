#include "estimator/calibration.h"

#include <cmath>

namespace virtual_work_dynamics {

Calibration calibrate(const Deviations& deviations, const InverseDynamics& dynamics,
                      const EffortJudge& judge, const EstimatedRows& estimated) {
  // Rounding, where a joint stands still and neither has an error.
  constexpr double kRounding = 1e-9;
  Deviations::Workspace spread = deviations.makeWorkspace();
  Workspace workspace = dynamics.makeWorkspace();
  double accelerations = 0;
  double efforts = 0;
  double count = 0;
  for (std::size_t i = 0; i < judge.rows().size(); ++i) {
    const Motion& motion = estimated.motions[i];
    if (motion.q.size() == 0) continue;
    deviations.computeMotion(motion, estimated.covariances[i], spread);
    dynamics.compute(motion, workspace);
    for (Eigen::Index j = 0; j < kArmJoints; ++j) {
      const double variance =
          estimated.covariances[i].coordinates[static_cast<std::size_t>(j)](2, 2);
      const double acceleration = std::abs(motion.qdd[j] - judge.truth(i).qdd[j]);
      const double effort = std::abs(workspace.effort()[j] - judge.effort(i)[j]);
      accelerations += acceleration <= 2 * std::sqrt(variance) + kRounding ? 1 : 0;
      efforts += effort <= 2 * spread.motion().effort[j] + kRounding ? 1 : 0;
      ++count;
    }
  }
  return {accelerations / count, efforts / count};
}

}  // namespace virtual_work_dynamics
