#include <cmath>

#include "tree/kernel/kernel_build.h"

namespace virtual_work_dynamics {

template <>
const Kernel<double>* baselineKernel<double>() {
  return KernelBuild<double, 2>::kernel();
}

template <>
const Kernel<float>* baselineKernel<float>() {
  return KernelBuild<float, 4>::kernel();
}

void sineCosineBeyond(double angle, double* sine, double* cosine) {
  *sine = std::sin(angle);
  *cosine = std::cos(angle);
}

}  // namespace virtual_work_dynamics
