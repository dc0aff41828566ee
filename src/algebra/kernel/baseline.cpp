#include "algebra/kernel/fronts.h"

namespace virtual_work_dynamics {

const FrontKernel* baselineFronts() {
  return frontKernel<2, 2>();
}

}  // namespace virtual_work_dynamics
