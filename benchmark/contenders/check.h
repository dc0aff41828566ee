#pragma once

#include <array>
#include <string>
#include <vector>

#include "contenders/contender.h"
#include "reference_113.h"

namespace virtual_work_dynamics {

/// What a scene's results are, and how far others are from it: of trees in 113 bits; of closed
/// loops in long double, by one linear system of all bodies with every joint cut. What rigid bodies
/// do not determine does not count.
class Yardstick {
 public:
  /// @param scene must outlive it.
  explicit Yardstick(const BenchmarkScene& scene);

  /// The largest error over all states: of an effort over the largest effort of the state, of a
  /// reaction's force or moment over the state's largest force or moment, of a completed position,
  /// velocity or acceleration over the state's largest. Infinite when a result is not finite. Runs
  /// the contender over all states, or as long as one of its calls is; over the first state only of
  /// closed loops with more than 50 joints and closures, for the reference's cost grows with their
  /// cube.
  /// @param outputs of the contender's label.
  /// @throws Error when the contender gives another number of results: reactions where none are
  /// due, too.
  double maxRelativeError(Contender& contender, const std::string& outputs) const;

 private:
  struct Effort {
    Real113 value;
    bool determined;
  };
  struct Reaction {
    Reference113::Wrench wrench;  // zero where it is not determined
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

/// The error beyond which a contender computes something else: none is better than its precision,
/// and some lose digits on long chains.
double agreementLimit(const std::string& precision);

}  // namespace virtual_work_dynamics
