#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <vector>

namespace virtual_work_dynamics {

/// A value of a recorded program: a constant, or the result of one of its nodes. It is as large as
/// a double and may be copied like one, through arrays of doubles too: a node stands as a NaN with
/// its number in it, and no constant of a plan is NaN.
class Term {
 public:
  Term() = default;
  explicit Term(double constant) { std::memcpy(&bits_, &constant, sizeof bits_); }
  static Term ofNode(std::uint32_t node) {
    Term term;
    term.bits_ = kMark | node;
    return term;
  }

  bool isNode() const { return (bits_ & kMark) == kMark; }
  bool is(double constant) const { return !isNode() && value() == constant; }
  std::uint32_t node() const { return static_cast<std::uint32_t>(bits_); }
  double value() const {
    double constant;
    std::memcpy(&constant, &bits_, sizeof constant);
    return constant;
  }
  std::uint64_t bits() const { return bits_; }

 private:
  static constexpr std::uint64_t kMark = 0x7ff8'7664'0000'0000;  // a quiet NaN
  std::uint64_t bits_;
};

inline bool operator==(const Term& a, const Term& b) {
  return a.bits() == b.bits();
}

enum class Operation : unsigned char {
  kInput,     ///< number `index` of the array `array`
  kAngle,     ///< cosine, sine or rest of the angle `index`, see Angle
  kNegate,    ///< -a
  kAdd,       ///< a + b
  kSubtract,  ///< a - b
  kMultiply,  ///< a b
  kMulAdd,    ///< a b + c, which rounds once, as the next three do where there is such an operation
  kSubMul,    ///< c - a b
  kMulSub,    ///< a b - c
  kMinusMulSub,  ///< -(a b) - c
  kProductRest,  ///< a b - c exactly, where c is a b rounded
  kHeld,         ///< a, or 1 or -1 where a is beyond
  kDivide,       ///< a / b
  kRoot,         ///< the square root of a
  kAwayFrom,     ///< b, with the sign turned where a is not negative
  kLarger,       ///< the larger of a and b; b where one of them is not a number
  kPositive,     ///< b where a is positive, else c
  kUnlessAbove,  ///< 0 where a > b, else 1: also where one of them is not a number
  kUnlessAtMost  ///< 0 where a <= b, else 1
};

/// What a node of Operation::kAngle is of its angle.
enum AnglePart { kCosine, kSine, kRest };

struct Node {
  Operation operation;
  Term a, b, c;   ///< as many as the operation has
  int array = 0;  ///< of an input: which one; of an angle: AnglePart
  int index = 0;
};

/// An angle whose sine and cosine a program needs.
struct Angle {
  Term angle;
  Term rest;  ///< what rounding took from the angle; zero where it took nothing
};

/// Where a term goes: number `index` of the array `array` of results.
struct GraphOutput {
  int array;
  int index;
  Term value;
};

/// Straight-line arithmetic. Each node is there once, whatever it is needed for; what can be
/// computed now is, rounded as it would be later. Products with 0 and 1 are left out: for finite
/// values they change nothing except for the sign of a zero.
/// Each node also has a value, that of one motion, by which what is recorded is chosen where it
/// depends on numbers: the choice is then noted, to be checked for every other motion.
class ExpressionGraph {
 public:
  Term input(int array, int index);
  /// Cosine, sine or rest of an angle.
  Term part(AnglePart part, const Angle& angle);

  Term negated(const Term& a);
  Term sum(const Term& a, const Term& b);
  Term difference(const Term& a, const Term& b);
  Term product(const Term& a, const Term& b);
  /// a b + c, with the product or c negated before; rounds once.
  Term fused(const Term& a, const Term& b, const Term& c, bool minus_product, bool minus_c);
  Term productRest(const Term& a, const Term& b, const Term& c);
  Term held(const Term& a);
  Term quotient(const Term& a, const Term& b);
  Term root(const Term& a);
  Term awayFrom(const Term& a, const Term& b);
  Term larger(const Term& a, const Term& b);
  Term positive(const Term& a, const Term& b, const Term& c);
  /// Adds up to failures() where a > b does not hold, or a <= b.
  void requireAbove(const Term& a, const Term& b);
  void requireAtMost(const Term& a, const Term& b);
  /// 1 where a > b does not hold, or a <= b, else 0.
  Term unlessAbove(const Term& a, const Term& b);
  Term unlessAtMost(const Term& a, const Term& b);
  /// Chooses by the present values whether a > b, and requires it to be so, or not to be.
  bool isAbove(const Term& a, const Term& b);
  /// How many requirements a motion fails.
  const Term& failures() const { return failures_; }
  void setFailures(const Term& failures) { failures_ = failures; }
  /// Gives an array of inputs other values, which are zero at first.
  void setValues(int array, const double* values);
  double valueOf(const Term& term) const {
    return term.isNode() ? values_[term.node()] : term.value();
  }

  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Angle>& angles() const { return angles_; }
  std::vector<GraphOutput> outputs;

 private:
  struct Key {
    std::uint64_t numbers[4];
    bool operator==(const Key& other) const {
      return std::memcmp(numbers, other.numbers, sizeof numbers) == 0;
    }
  };
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };

  Term node(const Node& node);
  double evaluated(const Node& node) const;
  // The term without its minus, and whether it had one.
  Term stripped(const Term& a, bool& minus) const;

  std::vector<Node> nodes_;
  std::vector<double> values_;  // of nodes
  std::vector<Angle> angles_;
  Term failures_{0};
  std::unordered_map<Key, std::uint32_t, Hash> index_of_;
};

}  // namespace virtual_work_dynamics
