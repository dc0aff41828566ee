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

  /// Whether its last output is a status, of which the function for one sample returns the number.
  bool judged = false;

  /// Whether rounding takes anything from an angle.
  bool anyRest() const;
};

/// The graph that the operations of this thread go to, for as long as it lives.
class GraphInUse {
 public:
  explicit GraphInUse(ExpressionGraph& graph);
  ~GraphInUse();
  GraphInUse(const GraphInUse&) = delete;
};

/// The arrays of one sample in terms.
struct SampleTerms {
  std::vector<Term> q, qd, qdd, root, orientations, applied;       ///< read
  std::vector<Term> effort, child_axes, root_axes, poses, twists;  ///< written
};

/// Makes the inputs of a plan.
/// @param wrenches how many of the plan's applied wrenches are inputs, the first; others are zero
SampleTerms inputsOf(const Plan<double>& plan, std::size_t wrenches, RecordedPlan& recording);
/// Runs the recursion once on terms.
void runOnTerms(const Plan<double>& plan, SampleTerms& terms, RecordedPlan& recording);
/// Adds an array of results, if it has any numbers.
void addOutputs(RecordedPlan& recording, const NamedArray& array, const std::vector<Term>& terms);
/// Adds the reactions.
void addReactions(RecordedPlan& recording, const std::vector<Term>& child_axes,
                  const std::vector<Term>& root_axes);

/// Records a plan.
RecordedPlan record(const Plan<double>& plan);

}  // namespace virtual_work_dynamics
