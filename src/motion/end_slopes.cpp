#include "motion/end_slopes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;

constexpr Index kMostRows = 5;
/// A slope that is less than this many times its uncertainty may as well be noise at rest.
constexpr double kCertainSlope = 3;

// The slope of the polynomial through the first rows, or counted from the end the last ones, in
// Newton's form: each further row adds the divided difference up to it, times the product of the
// distances of the rows between.
double slopeAt(bool at_end, const MotionTable& table, Index column) {
  const Index rows = std::min(kMostRows, table.positions.rows());
  std::array<double, kMostRows> t{}, difference{};
  for (Index i = 0; i < rows; ++i) {
    const Index row = at_end ? table.positions.rows() - 1 - i : i;
    const auto to = static_cast<std::size_t>(i);
    t[to] = table.times[static_cast<std::size_t>(row)];
    difference[to] = table.positions(row, column);
  }
  double slope = 0;
  double correction = 0;
  double product = 1;
  const auto count = static_cast<std::size_t>(rows);
  for (std::size_t order = 1; order < count; ++order) {
    for (std::size_t i = count - 1; i >= order; --i) {
      difference[i] = (difference[i] - difference[i - 1]) / (t[i] - t[i - order]);
    }
    if (order > 1) product *= t[0] - t[order - 1];
    correction = difference[order] * product;
    slope += correction;
  }
  return std::abs(slope) > kCertainSlope * std::abs(correction) ? slope : 0;
}

}  // namespace

EndSlopes endSlopes(const MotionTable& table) {
  EndSlopes slopes{Eigen::VectorXd::Zero(table.positions.cols()),
                   Eigen::VectorXd::Zero(table.positions.cols())};
  for (Index column = 0; column < table.positions.cols(); ++column) {
    slopes.start[column] = slopeAt(false, table, column);
    slopes.end[column] = slopeAt(true, table, column);
  }
  return slopes;
}

}  // namespace virtual_work_dynamics
