#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "generate/expression_graph.h"

namespace virtual_work_dynamics {

/// A node that is kept in memory between two parts of a program.
struct Kept {
  int slot;
  std::uint32_t node;
};

/// Some of the nodes of a program, in the order in which they are computed.
struct ProgramPart {
  std::vector<std::uint32_t> nodes;
  std::vector<Kept> taken;  ///< from parts before it
  std::vector<Kept> kept;   ///< for parts after it
};

/// What of a graph leads to its outputs, divided into parts that a compiler can cope with.
struct Program {
  std::vector<ProgramPart> parts;
  int slots = 0;  ///< numbers in memory between parts
};

/// The nodes that lead to the outputs, in parts of `most` operations or a little less: cut where
/// few values are alive. Inputs and angles are in every part that reads them.
Program programOf(const ExpressionGraph& graph, std::size_t most);

/// The nodes that lead to the angles and their rests, in their order.
std::vector<std::uint32_t> nodesOfAngles(const ExpressionGraph& graph);

/// Whether a node is read from an array and needs no operation.
inline bool isLeaf(const Node& node) {
  return node.operation == Operation::kInput || node.operation == Operation::kAngle;
}

/// How many operands of a node count.
int operandsOf(const Node& node);
inline const Term& operandOf(const Node& node, int i) {
  return i == 0 ? node.a : i == 1 ? node.b : node.c;
}

}  // namespace virtual_work_dynamics
