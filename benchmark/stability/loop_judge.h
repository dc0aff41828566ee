#pragma once

#include "stability/loop_verdict.h"

#ifdef VWD_HAS_REAL113

#include <string>
#include <vector>

#include "closed_loops.h"
#include "maximal_coordinates_oracle.h"
#include "stability/random_numbers.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {

/// A component of an effort or reaction as ClosedLoopDynamics has it.
struct LoopComponent {
  double value = 0;
  bool determined = false;
};

/// The same with all joints cut, in long double: MaximalCoordinatesOracle, whose rank is told by
/// the scene's tolerance.
struct ExactComponent {
  long double value = 0;
  long double freedom = 0;  ///< by how much null vectors change it
  bool turns = false;       ///< N m, not N

  bool determined() const { return freedom <= MaximalCoordinatesOracle::kFree; }
};

/// The components of all efforts and of the reactions of ground, joints and closures, root axes and
/// axes of the child.
using LoopComponents = std::vector<LoopComponent>;
using ExactComponents = std::vector<ExactComponent>;

/// Judges ClosedLoopDynamics on states of one mechanism.
///
/// An error is held against 4 (L + n) eps condition S. n is the number of unknowns of the loops and
/// L the depth of the tree; S the largest sum of the norms of loads (ErrorBound of the tree) plus
/// the largest force of the exact solution, moments over the size of the mechanism; the condition
/// that the package reports counts no more than ten times the exact system's. What does not count
/// for the rank is left out of the system: the largest such pivot is added to eps.
/// A component that null vectors change by f of a newton is good to f S besides. Where a singular
/// position does not bear its load there are no exact values, and only counts and flags are judged.
/// Within a factor of 100 of the tolerances of rank and flags either answer is right.
class LoopJudge {
 public:
  explicit LoopJudge(const StabilityCase& stability_case);

  /// @param random what the completion's start is off by
  LoopVerdict judge(const Motion& motion, RandomNumbers& random);

  /// Parts of it, for tests to put errors in between.
  LoopComponents compute(const Motion& motion);
  const Determinacy& determinacy() const { return dynamics_.determinacy(); }
  LoopVerdict compare(const Motion& motion, const LoopComponents& computed,
                      const Determinacy& determinacy) const;
  /// By how much exact results move with the motion, relative to the largest of their kind.
  double sensitivity(const Motion& motion, const Motion& moved) const;

 private:
  struct Exact {
    ExactComponents components;
    long double force = 0, moment = 0;  // the largest that are determined
    long double largest = 0;            // of all, moments over the size
    long double largest_left_out = 0, least_counted = 1;
    long double violation = 0;  // of an equation, where the load is not borne
    Eigen::Index redundancy = 0, free_motions = 0;
  };
  Exact exactOf(const Motion& motion) const;
  std::string nameOf(std::size_t component) const;
  long double loadOf(const Motion& motion) const;
  long double lossOf(const Exact& exact, const Determinacy& found) const;
  void compareCountsAndFlags(const Exact& exact, const LoopComponents& computed,
                             const Determinacy& found, LoopVerdict& verdict) const;
  void compareValues(const Exact& exact, const LoopComponents& computed, long double scale,
                     long double loss, LoopVerdict& verdict) const;
  void complete(const Motion& motion, double limit, RandomNumbers& random, LoopVerdict& verdict);

  Mechanism mechanism_;
  Scene scene_;
  std::vector<std::string> names_;
  ClosedLoops dynamics_;
  double size_ = 0;  // the largest distance from the root's origin to a joint's or a closure's
  int depth_ = 0;
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
