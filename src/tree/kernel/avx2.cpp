// Compiled with the instructions it is named after where the compiler has them; see CMakeLists.txt.
#if defined(__AVX2__)
#include "tree/kernel/kernel_build.h"
#else
#include "tree/kernel/kernel.h"
#endif

namespace virtual_work_dynamics {

template <>
const Kernel<double>* avx2Kernel<double>() {
#if defined(__AVX2__)
  return KernelBuild<double, 4>::kernel();
#else
  return nullptr;
#endif
}

template <>
const Kernel<float>* avx2Kernel<float>() {
#if defined(__AVX2__)
  return KernelBuild<float, 8>::kernel();
#else
  return nullptr;
#endif
}

}  // namespace virtual_work_dynamics
