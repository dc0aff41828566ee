#include "algebra/kernel/front_solutions.h"

namespace virtual_work_dynamics {

const FrontKernel* baselineFronts() {
  return frontKernel<2, 2>();
}

}  // namespace virtual_work_dynamics
