// Compiled with the instructions it is named after where the compiler has them; see sources.cmake.
#if defined(__AVX512F__)
#include "loops/kernel/closures.h"
#else
#include "loops/kernel/loop_kernel.h"
#endif

namespace virtual_work_dynamics {

const LoopKernel* avx512Loops() {
#if defined(__AVX512F__)
  return loopKernel<8>();
#else
  return nullptr;
#endif
}

}  // namespace virtual_work_dynamics
