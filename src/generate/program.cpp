#include "generate/program.h"

#include <algorithm>

namespace virtual_work_dynamics {

namespace {

constexpr std::size_t kNever = static_cast<std::size_t>(-1);

// Marks a node and all that it is computed from. Operands stand before what they are used for.
std::vector<bool> leadingTo(const ExpressionGraph& graph, const std::vector<Term>& wanted) {
  const std::vector<Node>& nodes = graph.nodes();
  std::vector<bool> needed(nodes.size(), false);
  for (const Term& term : wanted) {
    if (term.isNode()) needed[term.node()] = true;
  }
  for (std::size_t i = nodes.size(); i-- > 0;) {
    for (int j = 0; needed[i] && j < operandsOf(nodes[i]); ++j) {
      const Term& operand = operandOf(nodes[i], j);
      if (operand.isNode()) needed[operand.node()] = true;
    }
  }
  return needed;
}

// Divides operations into parts, and says what passes from one to another.
class Division {
 public:
  Division(const ExpressionGraph& graph, std::size_t most) : graph_(graph), most_(most) {}

  Program divide() {
    listOperations();
    findLastUses();
    cut();
    for (std::size_t p = 0; p < program_.parts.size(); ++p) connect(p);
    return std::move(program_);
  }

 private:
  const Node& nodeAt(std::size_t position) const { return graph_.nodes()[order_[position]]; }

  void listOperations() {
    std::vector<Term> wanted;
    for (const GraphOutput& output : graph_.outputs) wanted.push_back(output.value);
    const std::vector<bool> needed = leadingTo(graph_, wanted);
    place_.assign(needed.size(), kNever);
    for (std::uint32_t i = 0; i < needed.size(); ++i) {
      if (!needed[i] || isLeaf(graph_.nodes()[i])) continue;
      place_[i] = order_.size();
      order_.push_back(i);
    }
  }

  void findLastUses() {
    last_.assign(order_.size(), 0);
    for (std::size_t at = 0; at < order_.size(); ++at) {
      last_[at] = std::max(last_[at], at);
      for (int j = 0; j < operandsOf(nodeAt(at)); ++j) {
        const Term& operand = operandOf(nodeAt(at), j);
        if (operand.isNode() && place_[operand.node()] != kNever)
          last_[place_[operand.node()]] = at;
      }
    }
  }

  // How many results of operations before `position` are used from there on.
  std::vector<int> livesAt() const {
    std::vector<int> change(order_.size() + 2, 0);
    for (std::size_t at = 0; at < order_.size(); ++at) {
      ++change[at + 1];
      --change[last_[at] + 1];
    }
    for (std::size_t at = 1; at < change.size(); ++at) change[at] += change[at - 1];
    return change;
  }

  void cut() {
    const std::vector<int> alive = livesAt();
    part_of_.assign(order_.size(), 0);
    std::size_t begin = 0;
    do {
      std::size_t end = order_.size();
      if (end - begin > most_) {
        end = begin + most_;
        for (std::size_t at = end; at > begin + most_ / 2; --at) {
          if (alive[at] < alive[end]) end = at;
        }
      }
      ProgramPart part;
      for (std::size_t at = begin; at < end; ++at) {
        part_of_[at] = program_.parts.size();
        part.nodes.push_back(order_[at]);
      }
      program_.parts.push_back(part);
      begin = end;
    } while (begin < order_.size());
  }

  // Slots of values whose last part is behind are free again.
  int freeSlot(std::size_t part) {
    for (std::size_t slot = 0; slot < busy_until_.size(); ++slot) {
      if (busy_until_[slot] < part) return static_cast<int>(slot);
    }
    busy_until_.push_back(0);
    return program_.slots++;
  }

  void connect(std::size_t p) {
    ProgramPart& part = program_.parts[p];
    std::vector<std::uint32_t> taken;
    for (const std::uint32_t node : part.nodes) {
      for (int j = 0; j < operandsOf(graph_.nodes()[node]); ++j) {
        const Term& operand = operandOf(graph_.nodes()[node], j);
        if (!operand.isNode() || place_[operand.node()] == kNever) continue;
        if (part_of_[place_[operand.node()]] < p) taken.push_back(operand.node());
      }
    }
    std::sort(taken.begin(), taken.end());
    taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
    slots_.resize(graph_.nodes().size(), -1);
    for (const std::uint32_t node : taken) part.taken.push_back({slots_[node], node});
    for (const std::uint32_t node : part.nodes) {
      const std::size_t last_part = part_of_[last_[place_[node]]];
      if (last_part == p) continue;
      const int slot = freeSlot(p);
      busy_until_[static_cast<std::size_t>(slot)] = last_part;
      slots_[node] = slot;
      part.kept.push_back({slot, node});
    }
  }

  const ExpressionGraph& graph_;
  const std::size_t most_;
  Program program_;
  std::vector<std::uint32_t> order_;     // operations in their order
  std::vector<std::size_t> place_;       // by node, its position in order_
  std::vector<std::size_t> last_;        // by position, that of the last use
  std::vector<std::size_t> part_of_;     // by position
  std::vector<std::size_t> busy_until_;  // by slot, the last part that reads it
  std::vector<int> slots_;               // by node
};

}  // namespace

int operandsOf(const Node& node) {
  switch (node.operation) {
    case Operation::kInput:
    case Operation::kAngle:
      return 0;
    case Operation::kNegate:
    case Operation::kHeld:
    case Operation::kRoot:
      return 1;
    case Operation::kAdd:
    case Operation::kSubtract:
    case Operation::kMultiply:
    case Operation::kDivide:
    case Operation::kAwayFrom:
    case Operation::kLarger:
    case Operation::kUnlessAbove:
    case Operation::kUnlessAtMost:
      return 2;
    default:
      return 3;
  }
}

Program programOf(const ExpressionGraph& graph, std::size_t most) {
  return Division(graph, most).divide();
}

std::vector<std::uint32_t> nodesOfAngles(const ExpressionGraph& graph) {
  std::vector<Term> wanted;
  for (const Angle& angle : graph.angles()) wanted.insert(wanted.end(), {angle.angle, angle.rest});
  const std::vector<bool> needed = leadingTo(graph, wanted);
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < needed.size(); ++i) {
    if (needed[i]) nodes.push_back(i);
  }
  return nodes;
}

}  // namespace virtual_work_dynamics
