#pragma once

#include <string>
#include <vector>

#include "contenders/contender.h"
#include "reference_113.h"

namespace virtual_work_dynamics {

/// What a scene's results are, in 113 bits, and how far others are from it.
class Yardstick {
 public:
  explicit Yardstick(const BenchmarkScene& scene);

  /// The largest error over all states: of an effort over the largest effort of the state, of a
  /// reaction's force or moment over the state's largest force or moment. Infinite when a result
  /// is not finite. Runs the contender over all states, or as long as one of its calls is.
  /// @throws Error when the contender gives another number of results: reactions where none are
  /// due, too.
  double maxRelativeError(Contender& contender, bool with_reactions) const;

 private:
  struct State {
    std::vector<Real113> efforts;
    std::vector<Reference113::Wrench> reactions;
    Real113 largest_effort = 0, largest_force = 0, largest_moment = 0;
  };
  static Real113 relativeError(const SampleResults& results, const State& state,
                               bool with_reactions);

  std::vector<State> states_;
};

/// The error beyond which a contender computes something else: none is better than its precision,
/// and some lose digits on long chains.
double agreementLimit(const std::string& precision);

}  // namespace virtual_work_dynamics
