// Compiled with the instructions it is named after where the compiler has them; see sources.cmake.
#if defined(__AVX2__)
#include "algebra/kernel/front_solutions.h"
#else
#include "algebra/kernel/front_kernel.h"
#endif

namespace virtual_work_dynamics {

const FrontKernel* avx2Fronts() {
#if defined(__AVX2__)
  return frontKernel<4, 4>();
#else
  return nullptr;
#endif
}

}  // namespace virtual_work_dynamics
