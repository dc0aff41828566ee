#include "loops/kernel/closures.h"

namespace virtual_work_dynamics {

const LoopKernel* baselineLoops() {
  return loopKernel<2>();
}

}  // namespace virtual_work_dynamics
