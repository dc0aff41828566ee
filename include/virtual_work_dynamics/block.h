#pragma once

#include <cstddef>
#include <memory>

#include "virtual_work_dynamics/instruction_set.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// How the arrays of a block of N samples of C numbers lie in memory. Columns whose distance is a
/// multiple of 4096 bytes, as with 1024 doubles, compete for the same places in the caches: other
/// numbers of samples are faster.
enum class BlockLayout {
  kStructureOfArrays,  ///< number c of sample n at [c * N + n]
  kRowMajor            ///< number c of sample n at [n * C + c]
};

/// Motion of N samples; the arrays belong to the caller.
template <typename Real>
struct MotionBlock {
  std::size_t samples = 0;
  const Real* q = nullptr;    ///< positions, coordinates() numbers a sample, rad or m
  const Real* qd = nullptr;   ///< velocities, as many numbers a sample, rad/s or m/s
  const Real* qdd = nullptr;  ///< accelerations, as many numbers a sample, rad/s^2 or m/s^2
  /// The RootState of each sample, 9 numbers in its order; read where the scene's root moves.
  const Real* root = nullptr;
  /// Motion::orientations of each sample, x y z w of each; read where there are any.
  const Real* orientations = nullptr;
};

/// Where results of N samples go; the arrays belong to the caller, and results whose array is null
/// are not written.
template <typename Real>
struct ResultBlock {
  Real* effort = nullptr;      ///< coordinates() numbers a sample, N m or N
  Real* child_axes = nullptr;  ///< fx fy fz tx ty tz for each of Request::child_axes, N and N m
  Real* root_axes = nullptr;   ///< fx fy fz tx ty tz for each of Request::root_axes, N and N m
  Real* poses = nullptr;       ///< for each of Request::root_axes: x y z, then R_0K by rows
  Real* twists = nullptr;      ///< for each of Request::root_axes: vx vy vz wx wy wz, root axes
};

/// Inverse dynamics of blocks of samples, several samples in each vector instruction and blocks
/// divided among threads. Real: double or float. One instance serves one caller at a time.
template <typename Real>
class BlockInverseDynamics {
 public:
  /// Takes over the compiled plan of `inverse_dynamics`, which need not outlive it. Starts
  /// `threads` - 1 threads, which sleep between blocks.
  /// @throws Error when `threads` is less than 1 or the instruction set is not supported.
  explicit BlockInverseDynamics(const InverseDynamics& inverse_dynamics, int threads = 1,
                                InstructionSet instruction_set = chosenInstructionSet());
  ~BlockInverseDynamics();
  BlockInverseDynamics(BlockInverseDynamics&&) noexcept;
  BlockInverseDynamics& operator=(BlockInverseDynamics&&) noexcept;

  /// Number of generalized coordinates: the numbers a sample of q, qd, qdd and of the effort.
  std::size_t coordinates() const;
  const Request& request() const;
  int threads() const;
  InstructionSet instructionSet() const;

  /// Efforts and reactions of all samples; the numbers of a sample do not depend on its place in
  /// the block, on the layout or on the number of threads. Does not allocate.
  /// @throws MotionError when an input array is missing although the mechanism has coordinates, or
  ///   an output array is given that the request leaves out.
  void compute(BlockLayout layout, const MotionBlock<Real>& motion,
               const ResultBlock<Real>& results);

  /// Computes all samples with `load` in place of the values of the scene's applied wrenches.
  /// @throws SceneError when it has not one wrench for each of them.
  void compute(BlockLayout layout, const MotionBlock<Real>& motion, const Load& load,
               const ResultBlock<Real>& results);

  /// Computes all samples, each with a load of its own in place of the values of the scene's
  /// applied wrenches. @param loads one for each sample. @throws SceneError when one of them has
  /// not one wrench for each applied wrench.
  void compute(BlockLayout layout, const MotionBlock<Real>& motion, const Load* loads,
               const ResultBlock<Real>& results);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
