#include "estimator/effort_judge.h"

#include <cmath>
#include <utility>

namespace virtual_work_dynamics {

EffortJudge::EffortJudge(const InverseDynamics& dynamics, const EncoderRecording& recording,
                         std::vector<std::size_t> rows)
    : dynamics_(dynamics), rows_(std::move(rows)) {
  Workspace workspace = dynamics.makeWorkspace();
  Motion motion(kArmJoints);
  for (const std::size_t row : rows_) {
    recording.motion.evaluate(recording.times[row], motion);
    dynamics.compute(motion, workspace);
    truths_.push_back(motion);
    efforts_.push_back(workspace.effort());
  }
}

double EffortJudge::error(const std::vector<Motion>& estimates) const {
  Workspace workspace = dynamics_.makeWorkspace();
  Eigen::ArrayXd errors = Eigen::ArrayXd::Zero(kArmJoints);
  Eigen::ArrayXd sizes = Eigen::ArrayXd::Zero(kArmJoints);
  bool any = false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (estimates[i].q.size() == 0) continue;
    any = true;
    dynamics_.compute(estimates[i], workspace);
    errors += (workspace.effort() - efforts_[i]).array().square();
    sizes += efforts_[i].array().square();
  }
  return any ? std::sqrt((errors / sizes).maxCoeff()) : HUGE_VAL;
}

}  // namespace virtual_work_dynamics
