// Compiled with the instructions it is named after where the compiler has them; see CMakeLists.txt.
#if defined(__AVX512DQ__)
#include "tree/kernel/kernel_build.h"
#else
#include "tree/kernel/kernel.h"
#endif

namespace virtual_work_dynamics {

template <>
const Kernel<double>* avx512Kernel<double>() {
#if defined(__AVX512DQ__)
  return KernelBuild<double, 8>::kernel();
#else
  return nullptr;
#endif
}

template <>
const Kernel<float>* avx512Kernel<float>() {
#if defined(__AVX512DQ__)
  return KernelBuild<float, 16>::kernel();
#else
  return nullptr;
#endif
}

}  // namespace virtual_work_dynamics
