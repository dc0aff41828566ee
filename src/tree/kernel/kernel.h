#pragma once

#include <cstddef>

#include "base/alignment.h"
#include "tree/plan_types.h"

namespace virtual_work_dynamics {

// The recursion, compiled once for each instruction set behind plain pointers.
//
// The headers of this folder are compiled with instructions that a machine may lack. So that the
// linker can never put such a copy of a function in place of another, everything in them but this
// header is in unnamed namespaces, and they use nothing of the standard library or Eigen that is
// code; scripts/test.sh checks the objects.

/// Plan as the kernels see it.
template <typename R>
struct PlanView {
  const Body<R>* bodies;
  const JointPosition<R>* angles;
  const JointPosition<R>* slides;
  const ReactionOutput<R>* child_axes;
  const ReactionOutput<R>* root_axes;
  const MovedMoment<R>* moved;
  const PointStep* point_steps;
  const AppliedOutside<R>* applied;
  const ActuatorTerms<R>* actuators;
  const Carry* carries;
  const int* zero_efforts;
  int body_count, angle_count, slide_count, child_axes_count, root_axes_count, moved_count,
      applied_count, actuator_count, zero_effort_count, slots, wrench_count;
  bool static_motion, root_moves, any_pose, child_zeros, root_zeros, geared_angles;
  PlainWrench<R> root_wrench;
};

/// Number c of a sample is at [c * stride]; neighbouring samples follow each other.
template <typename R>
struct KernelInputs {
  const R* q;
  const R* qd;
  const R* qdd;
  std::size_t stride;
  /// Force and torque of each applied wrench: in Z axes and about O_k for those given in link axes,
  /// as given for those in root axes. Number c of wrench i is at [(6 i + c) * applied_stride];
  /// neighbouring samples follow each other.
  const R* applied;
  std::size_t applied_stride;
  /// A RootState where the root moves: number c is at [c * root_stride].
  const R* root = nullptr;
  std::size_t root_stride = 0;
  /// Orientations as x y z w of each: number c of orientation i is at [(4 i + c) *
  /// orientation_stride].
  const R* orientations = nullptr;
  std::size_t orientation_stride = 0;
};

/// Where results go, laid out as those of a ResultBlock; null: not wanted.
template <typename R>
struct KernelOutputs {
  R* effort;
  R* child_axes;
  R* root_axes;
  R* poses;
  R* twists;
  std::size_t stride;
};

/// The recursion for one instruction set. `scratch` points to scratch_size bytes, aligned to
/// kVectorAlignment, that prepare() has filled.
template <typename R>
struct Kernel {
  int width;  ///< samples of a pack
  std::size_t (*scratchSize)(const PlanView<R>& plan);
  void (*prepare)(const PlanView<R>& plan, void* scratch);
  /// Computes one sample; its strides are all 1, whatever they say.
  void (*one)(const PlanView<R>&, const KernelInputs<R>&, const KernelOutputs<R>&, void* scratch);
  /// Computes `width` neighbouring samples.
  void (*pack)(const PlanView<R>&, const KernelInputs<R>&, const KernelOutputs<R>&, void* scratch);
  /// Turns `width` rows of `columns` numbers into columns of `width` numbers, and back. A tile has
  /// room for `width` columns at least; what the rows do not fill is written, and read, too.
  void (*toColumns)(const R* rows, std::size_t columns, R* tile);
  void (*toRows)(const R* tile, std::size_t columns, R* rows);
};

// The builds of the recursion; null where the compiler cannot make one.
template <typename R>
const Kernel<R>* baselineKernel();
template <typename R>
const Kernel<R>* avx2Kernel();
template <typename R>
const Kernel<R>* avx512Kernel();

/// Sine and cosine of arguments too large for the kernels' own, or not finite.
void sineCosineBeyond(double angle, double* sine, double* cosine);

}  // namespace virtual_work_dynamics
