// Compiled with the instructions it is named after where the compiler has them; see CMakeLists.txt.
#if defined(__AVX2__)
#include "witness/momentum/momentum_sums.h"
#else
#include "witness/momentum/momentum.h"
#endif

namespace virtual_work_dynamics {

const Momentum* avx2Momentum() {
#if defined(__AVX2__)
  return &kMomentum;
#else
  return nullptr;
#endif
}

}  // namespace virtual_work_dynamics
