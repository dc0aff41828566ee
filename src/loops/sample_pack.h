#pragma once

#include <cstddef>
#include <vector>

#include "algebra/kernel/front_kernel.h"
#include "base/aligned_memory.h"
#include "loops/compiled_loops.h"
#include "loops/kernel/loop_kernel.h"

namespace virtual_work_dynamics {

/// Kinematics and forces of loops for several samples side by side, each number in a vector of
/// samples. What it finds is handed to the solvers of one sample, which go on from there. A sample
/// whose rank is not full beyond doubt, or whose null space changes efforts, is left to them.
/// Allocates in its constructor only.
class SamplePack {
 public:
  /// Whether samples of a plan can be computed so: its closures are all that it demands, none of
  /// them is actuated, springs change no wrench, and no policy weighs reactions.
  static bool serves(const ClosedLoopDynamics::Impl& plan);

  /// @param plan that it serves; must outlive it
  /// @param solvers made of this plan
  SamplePack(const ClosedLoopDynamics::Impl& plan, const LoopSolvers& solvers);

  /// How many samples it holds.
  std::size_t width() const { return width_; }
  /// Sets the motion of a sample.
  void setMotion(std::size_t sample, const Motion& motion);
  /// Sets the efforts of the open tree.
  void setEfforts(std::size_t sample, const Eigen::VectorXd& tree_effort);
  /// Computes all samples.
  void compute();
  /// Whether a sample was computed.
  bool computed(std::size_t sample) const { return computed_[sample]; }
  /// Puts a sample that was computed into the solvers.
  /// @param whole what flags and reactions need, too
  void take(std::size_t sample, const Motion& motion, bool whole, LoopSolvers& solvers) const;

 private:
  struct Group {
    std::vector<double*> entries;  // by block
    std::vector<const double*> entries_read;
    double *numbers, *load, *x, *closures, *condition, *null_square;
    std::vector<FrontState> states;
    std::vector<int> stairs;
  };
  void placeAndMove();
  void solve(const LoopForces& forces, Group& group);
  double* numbers(std::size_t place) const {
    return static_cast<double*>(memory_.get()) + place * width_;
  }

  const ClosedLoopDynamics::Impl& plan_;
  const LoopSolvers& solvers_;
  const LoopFunctions& loops_;
  const FrontFunctions& fronts_;
  std::size_t width_, coordinates_, conditions_, links_;
  AlignedMemory memory_;
  double *q_, *qd_, *qdd_, *efforts_, *angles_, *link_numbers_, *phi_, *A_, *wrenches_, *frames_;
  double *turning_, *rates_, *accelerations_, *norms_;
  std::vector<Group> groups_;
  std::vector<bool> computed_;
};

}  // namespace virtual_work_dynamics
