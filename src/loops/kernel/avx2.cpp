// Compiled with the instructions it is named after where the compiler has them; see sources.cmake.
#if defined(__AVX2__)
#include "loops/kernel/closures.h"
#else
#include "loops/kernel/loop_kernel.h"
#endif

namespace virtual_work_dynamics {

const LoopKernel* avx2Loops() {
#if defined(__AVX2__)
  return loopKernel<4>();
#else
  return nullptr;
#endif
}

}  // namespace virtual_work_dynamics
