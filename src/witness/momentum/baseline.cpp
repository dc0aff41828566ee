#include "witness/momentum/momentum_sums.h"

namespace virtual_work_dynamics {

const Momentum* baselineMomentum() {
  return &kMomentum;
}

}  // namespace virtual_work_dynamics
