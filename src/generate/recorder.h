#pragma once

#include <string>
#include <vector>

#include "generate/expression_graph.h"
#include "tree/plan.h"

namespace virtual_work_dynamics {

/// An array that a generated function reads or writes.
struct NamedArray {
  std::string name;
  int count = 0;     ///< numbers of a sample
  std::string says;  ///< what they are, and their units
};

/// The arithmetic of one evaluation of a plan.
struct RecordedPlan {
  ExpressionGraph graph;
  std::vector<NamedArray> inputs;   ///< Node::array is an index into these
  std::vector<NamedArray> outputs;  ///< GraphOutput::array is an index into these

  /// Whether rounding takes anything from an angle.
  bool anyRest() const;
};

/// Runs the recursion once on terms.
RecordedPlan record(const Plan<double>& plan);

}  // namespace virtual_work_dynamics
