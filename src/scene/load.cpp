#include "virtual_work_dynamics/load.h"

namespace virtual_work_dynamics {

Load::Load(const Scene& scene) {
  for (const AppliedWrench& applied : scene.applied_wrenches) {
    wrenches.push_back({applied.force, applied.torque});
  }
}

}  // namespace virtual_work_dynamics
