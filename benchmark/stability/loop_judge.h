#pragma once

#include "stability/loop_verdict.h"

#ifdef VWD_HAS_REAL113

#include <optional>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "maximal_coordinates_oracle.h"
#include "stability/random_numbers.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {

/// An effort, or a component of a reaction, of ClosedLoopDynamics.
struct LoopComponent {
  double value = 0;
  bool determined = false;
  bool exists = true;
};

/// An effort, or a component of a reaction, with all joints cut, in long double:
/// MaximalCoordinatesOracle, with the scene's tolerance of the rank.
struct ExactComponent {
  long double value = 0;
  long double freedom = 0;  ///< by how much null vectors change it, a moment over Exact::length
  bool turns = false;       ///< whether it is in N m, not in N
  /// By how much null vectors change a moment over the extent of its least loop; else as freedom.
  long double freedom_in_loop = 0;

  bool determined() const { return freedom <= MaximalCoordinatesOracle::kFree; }
  /// Whether its loop is so small that the exact equations, by their own length, call a change a
  /// rounding error that is none by the loop's.
  bool isOfTinyLoop() const {
    return determined() && freedom_in_loop > MaximalCoordinatesOracle::kFree;
  }
};

/// The components of the reactions of ground, joints and closures, of each in root axes and in axes
/// of the child, then all efforts, those of couplings last.
using LoopComponents = std::vector<LoopComponent>;
using ExactComponents = std::vector<ExactComponent>;

/// Judges ClosedLoopDynamics on states of one mechanism.
///
/// An error is compared with 4 (L + n) eps condition S. Here n is the number of unknowns of the
/// loops and L the depth of the tree; S is the largest sum of the norms of loads (ErrorBound of the
/// tree), plus what the strongest spring would exert over its rest length and the distances of its
/// ends from the root, which it compares, plus the largest force, of the exact solution where it is
/// determined, else of the one that was chosen, as errors of the equations grow with the solution
/// that they are put in; moments over the size of the mechanism. The condition that the package
/// reports counts up to ten times the exact system's. Entries that do not count for the rank are
/// left out of the system: the largest such pivot is added to eps, and so is the share of the
/// load's work along a free motion that nothing bears, while it is small enough to be rounding. The
/// package may choose another of many solutions than the exact equations do. Null vectors of these
/// are unit vectors of forces and of moments over a length of their own, which counts centres of
/// mass; so a force that they change by f may also be off by f S, and a moment by f S times that
/// length. Where a singular position does not bear its load there are no exact values, and only
/// counts and flags are judged. Everything exists where nothing moves freely, and in singular
/// positions what is determined of a load that is borne; where a load is clearly not borne,
/// something does not exist. Within a factor of 100 of the tolerances of rank and flags either
/// answer is right, and so it is for a moment that null vectors change by less than the tolerance
/// over the length of the exact equations and by more over the extent of its loop. What can only
/// press or pull is judged by the exact forces, unless these are within 1e-6 of the largest from
/// doing so. Coordinates whose efforts are residuals of a free motion count as actuated.
class LoopJudge {
 public:
  LoopJudge(const Mechanism& mechanism, const Scene& scene);

  /// Computes and compares a state.
  LoopVerdict judgeForces(const Motion& motion);
  /// Computes, compares and completes a state.
  /// @param random gives the error of the completion's start.
  LoopVerdict judge(const Motion& motion, RandomNumbers& random);

  // The parts of judge(), between which tests can put errors.
  LoopComponents compute(const Motion& motion);
  const Determinacy& determinacy() const { return dynamics_.determinacy(); }
  /// Number of coordinates whose efforts are residuals of a free motion.
  Eigen::Index residuals() const;
  LoopVerdict compare(const Motion& motion, const LoopComponents& computed,
                      const Determinacy& determinacy) const;
  /// By how much exact results move with the motion, relative to the largest of their kind.
  double sensitivity(const Motion& motion, const Motion& moved) const;

 private:
  struct Exact {
    ExactComponents components;
    long double force = 0, moment = 0;  // the largest ones that are determined
    long double largest_left_out = 0, least_counted = 1;
    long double unborne = 0;  // share of a load that nothing bears
    long double length = 1;   // that moments are compared with forces by, m
    Eigen::Index redundancy = 0, free_motions = 0;
  };
  Exact exactOf(const Motion& motion) const;
  std::vector<long double> extentsOf(const Motion& motion) const;
  std::size_t indexOf(const std::string& name) const;
  bool slides(const std::string& closure) const;
  std::string nameOf(std::size_t component) const;
  long double loadOf(const Motion& motion) const;
  long double springLoadOf(const Motion& motion) const;
  long double largestOf(const Exact& exact, const LoopComponents& computed) const;
  long double lossOf(const Exact& exact, const Determinacy& found) const;
  void compareCountsAndFlags(const Exact& exact, const LoopComponents& computed,
                             const Determinacy& found, LoopVerdict& verdict) const;
  void compareHolds(const Exact& exact, long double largest, LoopVerdict& verdict) const;
  std::optional<Hold> holdOf(const Closure& closure, const Exact& exact, long double edge) const;
  void compareValues(const Exact& exact, const LoopComponents& computed, long double scale,
                     long double loss, LoopVerdict& verdict) const;
  void complete(const Motion& motion, double limit, RandomNumbers& random, LoopVerdict& verdict);

  void countResidualsAsActuated();

  Mechanism mechanism_;
  Scene scene_;
  std::vector<std::string> names_;
  ClosedLoops dynamics_;
  double size_ = 0;  // largest distance of the origin of a joint or closure from the root's
  int depth_ = 0;
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
