#pragma once

#include <cstddef>
#include <vector>

#include "algebra/kernel/front_kernel.h"
#include "base/aligned_memory.h"
#include "loops/compiled_loops.h"
#include "loops/kernel/loop_kernel.h"

namespace virtual_work_dynamics {

/// Results of the open tree of several samples: number c of a sample lies at [c * stride], those of
/// neighbouring samples follow each other.
struct TreeNumbers {
  const double *effort, *child_axes, *root_axes;
  std::size_t stride;
};

/// Closed loops of several samples side by side, each number in a vector of samples. What it finds
/// is reported as records of numbers, or handed to the solvers of one sample, which go on from
/// there. A sample whose rank is not full beyond doubt, or whose null space changes efforts and has
/// more than one dimension, is left to them. Allocates in its constructor only.
class SamplePack {
 public:
  /// Whether samples of a plan can be computed so: its closures, wheels, contacts and teeth are all
  /// that it demands, none of them is actuated, springs change no wrench, and no policy weighs
  /// reactions.
  static bool serves(const ClosedLoopDynamics::Impl& plan);

  /// @param plan that it serves; must outlive it
  /// @param solvers made of this plan
  SamplePack(const ClosedLoopDynamics::Impl& plan, const LoopSolvers& solvers);

  /// How many samples it holds.
  std::size_t width() const { return width_; }
  /// Sets positions, velocities and accelerations of all samples: those of a coordinate lie
  /// `stride` numbers from those of the one before.
  void setMotion(const double* q, const double* qd, const double* qdd, std::size_t stride);
  /// Sets the efforts of the open tree.
  void setEfforts(const TreeNumbers& tree);
  void setEfforts(std::size_t sample, const Eigen::VectorXd& tree_effort);
  /// Computes all samples.
  void compute();
  /// Whether a sample was computed.
  bool computed(std::size_t sample) const { return computed_[sample]; }

  /// How many numbers each result has in a record of report(), in their order.
  struct Record {
    std::size_t efforts;     ///< by coordinate, zero where it is passive
    std::size_t loads;       ///< two wrenches of each closure, as in LoopResults::tree_wrenches
    std::size_t plain;       ///< three of each ClosureResidual, where they are asked for
    std::size_t relative;    ///< as many
    std::size_t conditions;  ///< by group
    std::size_t holds;       ///< by name, the number of a Hold
    std::size_t chosen;      ///< by group, how many dimensions of its null space set efforts
    std::size_t child_axes, root_axes;
    std::size_t numbers() const {
      return efforts + loads + plain + relative + conditions + holds + chosen + child_axes +
             root_axes;
    }
  };
  const Record& record() const { return record_; }
  /// Writes the records of all samples, number by number.
  void report(const TreeNumbers& tree, double* records) const;
  /// Puts a sample that was computed into solvers and results.
  /// @param whole what flags and reactions need, too
  void take(std::size_t sample, bool whole, LoopSolvers& solvers, LoopResults& results) const;

 private:
  struct Group {
    std::vector<double*> entries;  // by block
    std::vector<const double*> entries_read;
    double *numbers, *load, *x, *condition, *null_square;
    std::vector<FrontState> states;
    std::vector<int> stairs;
    std::vector<std::size_t> items;  // of LoopHolds
    // Unknowns whose parts in the null space are found: efforts that must not change, then those of
    // items, where there is a null space.
    std::vector<Eigen::Index> unknowns;
    std::size_t efforts;
    double *null_vector, *chosen;  // null_vector: null where none is needed
    std::vector<bool> reached;     // by front
  };
  Group groupOf(std::size_t index) const;
  ClosureNumbers numbersOf(std::size_t closure) const;
  void place();
  void findResiduals();
  void takeResiduals(std::size_t sample, LoopResults& results) const;
  void solve(const LoopForces& forces, Group& group);
  void subtractConstants();
  void sumWrenches(const LoopForces& forces, const Group& group);
  static bool choosesAlong(const LoopForces& forces);
  void findNullVector(const MultifrontalQr& qr, const FrontsMemory& memory, Group& group);
  void chooseEfforts(const LoopForces& forces, const FrontsMemory& memory, Group& group);
  bool isUnique(const Group& group, std::size_t sample) const;
  void judge(const LoopForces& forces, const Group& group);
  void judgeHolds(const LoopForces& forces, const Group& group);
  void reportEfforts(const TreeNumbers& tree, double* to) const;
  double* numbers(std::size_t place) const {
    return static_cast<double*>(memory_.get()) + place * width_;
  }

  const ClosedLoopDynamics::Impl& plan_;
  const LoopSolvers& solvers_;
  const LoopFunctions& loops_;
  const FrontFunctions& fronts_;
  std::size_t width_, coordinates_, conditions_, links_;
  Record record_;
  AlignedMemory memory_;
  double *q_, *qd_, *qdd_, *efforts_, *angles_, *link_numbers_, *phi_, *A_, *wrenches_, *frames_;
  double *turning_, *rates_, *accelerations_, *residuals_, *closures_, *roundings_, *holds_;
  std::vector<Group> groups_;
  std::vector<bool> computed_;
};

}  // namespace virtual_work_dynamics
