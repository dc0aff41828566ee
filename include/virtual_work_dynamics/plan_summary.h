#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// What a compiled plan costs and what it left out, from InverseDynamics::summary().
struct PlanSummary {
  std::size_t bodies = 0;  ///< rigid bodies of the recursion, the root among them
  /// Operations of one sample, counted by running the recursion on a number type that counts; a
  /// fused multiply-add is one of each. Sines and cosines are not among them.
  std::size_t multiplications = 0;
  std::size_t additions = 0;
  std::size_t sines_and_cosines = 0;  ///< pairs, one for each turning joint that matters
  /// One line for each kind of thing left out, with names: "fixed joints, merged into their parents
  /// (2): tool0, ee_fixed".
  std::vector<std::string> left_out;

  /// The summary as lines of text for a reader.
  std::vector<std::string> lines() const;
};

}  // namespace virtual_work_dynamics
