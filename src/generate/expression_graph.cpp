#include "generate/expression_graph.h"

#include <cmath>
#include <utility>

namespace virtual_work_dynamics {

namespace {

bool constants(const Term& a, const Term& b) {
  return !a.isNode() && !b.isNode();
}

}  // namespace

std::size_t ExpressionGraph::Hash::operator()(const Key& key) const {
  std::uint64_t hash = 0;
  for (const std::uint64_t number : key.numbers) {
    hash = (hash ^ number) * 0x9e3779b97f4a7c15;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

Term ExpressionGraph::node(const Node& node) {
  const std::uint64_t kind = static_cast<std::uint64_t>(node.operation) |
                             static_cast<std::uint64_t>(node.array) << 8 |
                             static_cast<std::uint64_t>(node.index) << 32;
  const Key key = {{kind, node.a.bits(), node.b.bits(), node.c.bits()}};
  const auto [found, added] = index_of_.try_emplace(key, nodes_.size());
  if (added) {
    nodes_.push_back(node);
    values_.push_back(evaluated(node));
  }
  return Term::ofNode(found->second);
}

double ExpressionGraph::evaluated(const Node& node) const {
  const double a = valueOf(node.a), b = valueOf(node.b), c = valueOf(node.c);
  switch (node.operation) {
    case Operation::kInput:
      return 0;
    case Operation::kAngle: {
      const Angle& angle = angles_[static_cast<std::size_t>(node.index)];
      const double at = valueOf(angle.angle);
      return node.array == kCosine ? std::cos(at)
             : node.array == kSine ? std::sin(at)
                                   : valueOf(angle.rest);
    }
    case Operation::kNegate:
      return -a;
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kMulAdd:
      return std::fma(a, b, c);
    case Operation::kSubMul:
      return std::fma(-a, b, c);
    case Operation::kMulSub:
    case Operation::kProductRest:
      return std::fma(a, b, -c);
    case Operation::kMinusMulSub:
      return std::fma(-a, b, -c);
    case Operation::kHeld:
      return a < -1 ? -1.0 : a > 1 ? 1.0 : a;
    case Operation::kDivide:
      return a / b;
    case Operation::kRoot:
      return std::sqrt(a);
    case Operation::kAwayFrom:
      return a < 0 ? b : -b;
    case Operation::kLarger:
      return a > b ? a : b;
    case Operation::kPositive:
      return a > 0 ? b : c;
    case Operation::kUnlessAbove:
      return a > b ? 0 : 1;
    case Operation::kUnlessAtMost:
      return a <= b ? 0 : 1;
  }
  return 0;
}

Term ExpressionGraph::input(int array, int index) {
  return node({Operation::kInput, Term(0), Term(0), Term(0), array, index});
}

void ExpressionGraph::setValues(int array, const double* values) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (node.operation != Operation::kInput) {
      values_[i] = evaluated(node);
    } else if (node.array == array) {
      values_[i] = values[node.index];
    }
  }
}

Term ExpressionGraph::part(AnglePart part, const Angle& angle) {
  if (part == kRest && angle.rest.is(0)) return Term(0);
  std::size_t i = 0;
  while (i < angles_.size() && !(angles_[i].angle == angle.angle && angles_[i].rest == angle.rest))
    ++i;
  if (i == angles_.size()) angles_.push_back(angle);
  return node({Operation::kAngle, Term(0), Term(0), Term(0), part, static_cast<int>(i)});
}

Term ExpressionGraph::stripped(const Term& a, bool& minus) const {
  if (a.isNode()) {
    const Node& inside = nodes_[a.node()];
    if (inside.operation != Operation::kNegate) return a;
    minus = !minus;
    return inside.a;
  }
  if (!std::signbit(a.value())) return a;
  minus = !minus;
  return Term(-a.value());
}

Term ExpressionGraph::negated(const Term& a) {
  bool minus = true;
  const Term inside = stripped(a, minus);
  if (!minus) return inside;
  if (!inside.isNode()) return Term(-inside.value());
  return node({Operation::kNegate, inside, Term(0), Term(0)});
}

Term ExpressionGraph::sum(const Term& a, const Term& b) {
  if (constants(a, b)) return Term(a.value() + b.value());
  if (a.is(0)) return b;
  if (b.is(0)) return a;
  bool minus_a = false, minus_b = false;
  Term left = stripped(a, minus_a), right = stripped(b, minus_b);
  if (minus_a && minus_b) return negated(sum(left, right));
  if (minus_a != minus_b && left == right) return Term(0);
  if (minus_b) return node({Operation::kSubtract, a, right, Term(0)});
  if (minus_a) return node({Operation::kSubtract, b, left, Term(0)});
  if (right.bits() < left.bits()) std::swap(left, right);
  return node({Operation::kAdd, left, right, Term(0)});
}

Term ExpressionGraph::difference(const Term& a, const Term& b) {
  if (constants(a, b)) return Term(a.value() - b.value());
  return sum(a, negated(b));
}

Term ExpressionGraph::product(const Term& a, const Term& b) {
  if (constants(a, b)) return Term(a.value() * b.value());
  if (a.is(0) || b.is(0)) return Term(0);
  bool minus = false;
  Term left = stripped(a, minus), right = stripped(b, minus);
  if (right.bits() < left.bits()) std::swap(left, right);
  Term result;
  if (left.is(1)) {
    result = right;
  } else if (right.is(1)) {
    result = left;
  } else {
    result = node({Operation::kMultiply, left, right, Term(0)});
  }
  return minus ? negated(result) : result;
}

Term ExpressionGraph::fused(const Term& a, const Term& b, const Term& c, bool minus_product,
                            bool minus_c) {
  if (a.is(0) || b.is(0)) return minus_c ? negated(c) : c;
  const Term added = minus_c ? negated(c) : c;
  const auto exact = [](const Term& term) { return !term.isNode() && std::abs(term.value()) == 1; };
  if (c.is(0) || exact(a) || exact(b)) {
    const Term all = product(a, b);
    return sum(minus_product ? negated(all) : all, added);
  }
  if (constants(a, b) && !added.isNode()) {
    const double factor = minus_product ? -a.value() : a.value();
    return Term(std::fma(factor, b.value(), added.value()));
  }
  Term left = stripped(a, minus_product), right = stripped(b, minus_product);
  if (right.bits() < left.bits()) std::swap(left, right);
  bool minus_added = false;
  Term rest = stripped(added, minus_added);
  const Operation operation = minus_product
                                  ? (minus_added ? Operation::kMinusMulSub : Operation::kSubMul)
                                  : (minus_added ? Operation::kMulSub : Operation::kMulAdd);
  return node({operation, left, right, rest});
}

Term ExpressionGraph::productRest(const Term& a, const Term& b, const Term& c) {
  if (constants(a, b)) return Term(std::fma(a.value(), b.value(), -c.value()));
  if (std::abs(a.isNode() ? 0 : a.value()) == 1) return Term(0);
  return node({Operation::kProductRest, a, b, c});
}

Term ExpressionGraph::held(const Term& a) {
  if (!a.isNode()) return Term(a.value() < -1 ? -1.0 : a.value() > 1 ? 1.0 : a.value());
  return node({Operation::kHeld, a, Term(0), Term(0)});
}

Term ExpressionGraph::quotient(const Term& a, const Term& b) {
  if (constants(a, b)) return Term(a.value() / b.value());
  if (a.is(0)) return a;
  if (b.is(1)) return a;
  if (b.is(-1)) return negated(a);
  return node({Operation::kDivide, a, b, Term(0)});
}

Term ExpressionGraph::root(const Term& a) {
  if (!a.isNode()) return Term(std::sqrt(a.value()));
  return node({Operation::kRoot, a, Term(0), Term(0)});
}

Term ExpressionGraph::awayFrom(const Term& a, const Term& b) {
  if (!a.isNode()) return a.value() < 0 ? b : negated(b);
  return node({Operation::kAwayFrom, a, b, Term(0)});
}

Term ExpressionGraph::larger(const Term& a, const Term& b) {
  if (constants(a, b)) return a.value() > b.value() ? a : b;
  return a == b ? a : node({Operation::kLarger, a, b, Term(0)});
}

Term ExpressionGraph::positive(const Term& a, const Term& b, const Term& c) {
  if (!a.isNode()) return a.value() > 0 ? b : c;
  return b == c ? b : node({Operation::kPositive, a, b, c});
}

Term ExpressionGraph::unlessAbove(const Term& a, const Term& b) {
  if (constants(a, b)) return Term(a.value() > b.value() ? 0 : 1);
  return node({Operation::kUnlessAbove, a, b, Term(0)});
}

Term ExpressionGraph::unlessAtMost(const Term& a, const Term& b) {
  if (constants(a, b)) return Term(a.value() <= b.value() ? 0 : 1);
  return node({Operation::kUnlessAtMost, a, b, Term(0)});
}

void ExpressionGraph::requireAbove(const Term& a, const Term& b) {
  failures_ = sum(failures_, unlessAbove(a, b));
}

void ExpressionGraph::requireAtMost(const Term& a, const Term& b) {
  failures_ = sum(failures_, unlessAtMost(a, b));
}

bool ExpressionGraph::isAbove(const Term& a, const Term& b) {
  const bool above = valueOf(a) > valueOf(b);
  if (constants(a, b)) return above;
  above ? requireAbove(a, b) : requireAtMost(a, b);
  return above;
}

}  // namespace virtual_work_dynamics
