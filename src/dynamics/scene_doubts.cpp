#include "dynamics/scene_doubts.h"

#include <string>
#include <vector>

#include "base/number_text.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

void requireShare(const char* name, double value) {
  if (value >= 0 && value < 1) return;
  throw SceneError(std::string("tolerances.") + name + ": " + numberText(value) +
                   " is not from 0 to below 1");
}

}  // namespace

void requireSoundDoubts(const Scene& scene) {
  requireShare("mass", scene.tolerances.mass);
  requireShare("inertia", scene.tolerances.inertia);
  for (const AppliedWrench& wrench : scene.applied_wrenches) {
    const WrenchDeviation own = wrench.deviation.value_or(WrenchDeviation());
    for (const double value : {own.force, own.torque}) {
      if (value >= 0) continue;
      throw SceneError("applied_wrenches: a deviation of " + numberText(value) +
                       " is not zero or more");
    }
  }
}

std::vector<WrenchCovariance> wrenchCovariances(const Scene& scene) {
  std::vector<WrenchCovariance> covariances;
  for (const AppliedWrench& wrench : scene.applied_wrenches) {
    const WrenchDeviation own = wrench.deviation.value_or(WrenchDeviation());
    WrenchCovariance covariance = WrenchCovariance::Zero();
    covariance.diagonal() << Eigen::Vector3d::Constant(own.force * own.force),
        Eigen::Vector3d::Constant(own.torque * own.torque);
    covariances.push_back(covariance);
  }
  return covariances;
}

}  // namespace virtual_work_dynamics
