#pragma once

#include <array>
#include <string>
#include <vector>

#include "contenders/contender.h"
#include "reference_113.h"

namespace virtual_work_dynamics {

/// The true results of a scene, and how far others are from them. Trees are computed in 113 bits;
/// closed loops in long double, by one linear system of all bodies with every joint cut. Results
/// that rigid bodies do not determine do not count.
class Yardstick {
 public:
  /// @param scene must outlive this object.
  explicit Yardstick(const BenchmarkScene& scene);

  /// Runs the contender and returns its largest relative error: of an effort over the largest
  /// effort of the state, of a reaction's force or moment over the state's largest force or moment,
  /// of a completed position, velocity or acceleration over the state's largest. Infinite when a
  /// result is not finite. The contender runs over all states, or for as many as one of its calls
  /// has; with more than 50 joints and closures in closed loops only the first state counts, as the
  /// cost of the reference grows with their cube.
  /// @param outputs Label::outputs of the contender.
  /// @throws Error when the contender gives another number of results, or reactions that it should
  ///   not give.
  double maxRelativeError(Contender& contender, const std::string& outputs) const;

 private:
  struct Effort {
    Real113 value;
    bool determined;
  };
  struct Reaction {
    Reference113::Wrench wrench;  // zero where not determined
    std::array<bool, 6> determined;
  };
  struct State {
    std::vector<Effort> efforts;
    std::vector<Reaction> reactions;
    const Motion* motion = nullptr;
    Real113 largest_effort = 0, largest_force = 0, largest_moment = 0;
  };
  static State stateOfTree(const BenchmarkScene& scene, const Motion& motion);
  static State stateOfLoops(const BenchmarkScene& scene, const Motion& motion);
  static void addReaction(State& state, const Reaction& reaction);
  static Real113 relativeError(const SampleResults& results, const State& state,
                               const std::string& outputs);

  std::vector<State> states_;
};

/// The relative error beyond which a contender does not compute the same results. It allows for the
/// precision, and for the digits that some contenders lose on long chains.
double agreementLimit(const std::string& precision);

}  // namespace virtual_work_dynamics
