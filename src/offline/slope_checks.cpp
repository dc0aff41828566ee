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

struct Unit {
  double factor;
  const char* name;
};
constexpr std::array<Unit, 3> kUnits{
    {{57.29578, "degrees"}, {1000, "millimetres"}, {1 / 9.80665, "multiples of g"}}};

using Column = Eigen::Ref<const Eigen::VectorXd>;

// By what factor values go with the slopes of others; 1 where nothing tells.
double factorOf(const std::vector<double>& times, const Column& of, const Column& values) {
  double slopes = 0, products = 0, squares = 0;
  int moving = 0;
  for (Eigen::Index row = 1; row + 1 < of.size(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    const double slope = (of[row + 1] - of[row - 1]) / (times[at + 1] - times[at - 1]);
    slopes += slope * slope;
    products += slope * values[row];
    squares += values[row] * values[row];
    moving += slope != 0 && values[row] != 0;
  }
  const bool tells = moving >= kFewest && products * products > (1 - kLeft) * slopes * squares;
  return tells ? products / slopes : 1;
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
    const auto judge = [&](const char* what, const Eigen::MatrixXd& values, const char* of,
                           const Eigen::MatrixXd& positions) {
      const double factor = factorOf(motion.times, positions.col(column), values.col(column));
      if (factor > kLargestFactor || factor < 1 / kLargestFactor) {
        doubts.push_back(doubt(what, motion.joints[i], of, factor));
      }
    };
    judge("velocities", motion.velocities, "positions", motion.positions);
    judge("accelerations", motion.accelerations, "velocities", motion.velocities);
  }
  return doubts;
}

}  // namespace virtual_work_dynamics
