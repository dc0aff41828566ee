#include "offline/slope_checks.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLargestFactor = 2;
// Of the variance of what is given, the part that a factor of the slopes has to leave at the most.
constexpr double kLeft = 0.1;
constexpr int kFewest = 10;  // rows that move
// s from row to row, on average; what swings between rows that are farther apart has other slopes.
constexpr double kFarthestRows = 0.1;

// The least part that slopes over four steps are of those over two: a swing with six rows or more.
constexpr double kResolved = 0.5;
// What swings about once from row to row seems to go slowly, and backwards if a little less often.
constexpr double kLeastAlias = 4;

struct Unit {
  double factor;
  const char* name;
};
constexpr std::array<Unit, 3> kUnits{
    {{57.29578, "degrees"}, {1000, "millimetres"}, {1 / 9.80665, "multiples of g"}}};

using Column = Eigen::Ref<const Eigen::VectorXd>;

// By what factor values go with the slopes of others, between the rows so far before and after each
// row; 1 where nothing tells.
double factorOf(const std::vector<double>& times, const Column& of, const Column& values,
                Eigen::Index far) {
  double slopes = 0, products = 0, squares = 0;
  int moving = 0;
  for (Eigen::Index row = far; row + far < of.size(); ++row) {
    const auto after = static_cast<std::size_t>(row + far);
    const auto before = static_cast<std::size_t>(row - far);
    const double slope = (of[row + far] - of[row - far]) / (times[after] - times[before]);
    slopes += slope * slope;
    products += slope * values[row];
    squares += values[row] * values[row];
    moving += slope != 0 && values[row] != 0;
  }
  const bool tells = moving >= kFewest && products * products > (1 - kLeft) * slopes * squares;
  return tells ? products / slopes : 1;
}

// 1 also where rows are too far apart for slopes, so that these depend on how far.
double resolvedFactor(const std::vector<double>& times, const Column& of, const Column& values) {
  const double factor = factorOf(times, of, values, 1), wider = factorOf(times, of, values, 2);
  const bool resolved = factor / wider > kResolved && factor / wider < 1 / kResolved;
  return resolved && factor > -kLeastAlias ? factor : 1;
}

bool isDoubtful(double factor) {
  return factor > kLargestFactor || factor < 1 / kLargestFactor;
}

std::string doubt(const char* what, const std::string& joint, const char* of, double factor) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.3g", factor);
  std::string text = std::string(what) + " of " + inQuotes(joint) + " are " + digits +
                     " times the slope of its " + of;
  for (const Unit& unit : kUnits) {
    if (std::abs(factor / unit.factor - 1) < 0.05)
      text += std::string(": are they ") + unit.name + "?";
  }
  return text;
}

}  // namespace

std::vector<std::string> slopeDoubts(const MotionTable& motion) {
  std::vector<std::string> doubts;
  const std::vector<double>& times = motion.times;
  const auto steps = static_cast<double>(times.size()) - 1;
  if (steps < kFewest || times.back() - times.front() > kFarthestRows * steps) return doubts;
  for (std::size_t i = 0; i < motion.joints.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const auto factor = [&](const Eigen::MatrixXd& of, const Eigen::MatrixXd& values) {
      return resolvedFactor(times, of.col(column), values.col(column));
    };
    const double velocity = factor(motion.positions, motion.velocities);
    const double acceleration = factor(motion.velocities, motion.accelerations);
    // Both derivatives of what swings a little more often than once from row to row.
    const bool alias = velocity > kLeastAlias && std::abs(acceleration / velocity - 1) < 0.05;
    if (alias) continue;
    if (isDoubtful(velocity))
      doubts.push_back(doubt("velocities", motion.joints[i], "positions", velocity));
    if (isDoubtful(acceleration))
      doubts.push_back(doubt("accelerations", motion.joints[i], "velocities", acceleration));
  }
  return doubts;
}

}  // namespace virtual_work_dynamics
