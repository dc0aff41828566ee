#include "generate/expression_graph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/checksum.h"
#include "generate/program.h"

namespace virtual_work_dynamics {
namespace {

TEST(ExpressionGraph, FoldsConstantsWithOneRounding) {
  ExpressionGraph graph;
  const double a = 1 + std::ldexp(1, -30), c = -1 - std::ldexp(1, -29);
  EXPECT_EQ(graph.fused(Term(a), Term(a), Term(c), false, false).value(), std::ldexp(1, -60));
  EXPECT_EQ(graph.sum(graph.product(Term(a), Term(a)), Term(c)).value(), 0);
  EXPECT_EQ(graph.fused(Term(2), Term(3), Term(4), true, true).value(), -10);
  EXPECT_EQ(graph.difference(Term(2), Term(3)).value(), -1);
  EXPECT_EQ(graph.held(Term(-3)).value(), -1);
  EXPECT_TRUE(graph.nodes().empty());
}

TEST(ExpressionGraph, HasEveryOperationOnce) {
  ExpressionGraph graph;
  const Term x = graph.input(0, 0), y = graph.input(0, 1);
  EXPECT_FALSE(x == y);
  EXPECT_TRUE(graph.product(x, y) == graph.product(y, x));
  EXPECT_TRUE(graph.sum(x, y) == graph.sum(y, x));
  EXPECT_TRUE(graph.product(graph.negated(x), y) == graph.negated(graph.product(x, y)));
  EXPECT_TRUE(graph.fused(x, y, x, true, false) ==
              graph.fused(y, graph.negated(x), x, false, false));
  EXPECT_FALSE(graph.difference(x, y) == graph.difference(y, x));
  EXPECT_FALSE(graph.fused(x, y, x, false, true) == graph.fused(x, y, x, false, false));
}

TEST(ExpressionGraph, LeavesOutZerosAndOnes) {
  ExpressionGraph graph;
  const Term x = graph.input(0, 0), y = graph.input(0, 1), zero = Term(0), one = Term(1);
  EXPECT_TRUE(graph.product(x, zero).is(0));
  EXPECT_TRUE(graph.product(one, x) == x);
  EXPECT_TRUE(graph.sum(x, zero) == x);
  EXPECT_TRUE(graph.difference(zero, x) == graph.negated(x));
  EXPECT_TRUE(graph.negated(graph.negated(x)) == x);
  EXPECT_TRUE(graph.fused(x, zero, y, false, true) == graph.negated(y));
  EXPECT_TRUE(graph.fused(x, Term(-1), y, false, false) == graph.difference(y, x));
  EXPECT_TRUE(graph.fused(x, y, zero, true, false) == graph.negated(graph.product(x, y)));
  EXPECT_TRUE(graph.difference(x, x).is(0));
}

TEST(ExpressionGraph, IsDividedSoThatEachPartFindsWhatItReads) {
  ExpressionGraph graph;
  std::vector<Term> values = {graph.input(0, 0), graph.input(0, 1)};
  for (std::size_t i = 2; i < 60; ++i) {
    values.push_back(graph.sum(values[i - 1], graph.product(values[i - 2], values[i / 2])));
  }
  graph.outputs.push_back({0, 0, values.back()});
  const Program program = programOf(graph, 10);
  ASSERT_GT(program.parts.size(), 5u);
  std::vector<std::uint32_t> memory(static_cast<std::size_t>(program.slots), 0);
  std::size_t operations = 0;
  for (const ProgramPart& part : program.parts) {
    EXPECT_LE(part.nodes.size(), 10u);
    std::vector<bool> known(graph.nodes().size(), false);
    for (const Kept& kept : part.taken) {
      EXPECT_EQ(memory[static_cast<std::size_t>(kept.slot)], kept.node);
      known[kept.node] = true;
    }
    for (const std::uint32_t node : part.nodes) {
      ++operations;
      for (int i = 0; i < operandsOf(graph.nodes()[node]); ++i) {
        const std::uint32_t operand = operandOf(graph.nodes()[node], i).node();
        EXPECT_TRUE(isLeaf(graph.nodes()[operand]) || known[operand]);
      }
      known[node] = true;
    }
    for (const Kept& kept : part.kept) memory[static_cast<std::size_t>(kept.slot)] = kept.node;
  }
  EXPECT_EQ(operations, graph.nodes().size() - 2);
}

TEST(Checksum, IsThatOfCksum) {
  EXPECT_EQ(posixChecksum("123456789"), 930766865u);
  EXPECT_EQ(posixChecksum(""), 4294967295u);
}

}  // namespace
}  // namespace virtual_work_dynamics
