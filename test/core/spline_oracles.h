#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {
namespace spline_oracles {

/// Expects that |value - expected| <= tolerance max(1, |expected|), and that the value is finite.
inline void expectClose(double value, double expected, double tolerance, const std::string& what) {
  ASSERT_TRUE(std::isfinite(value)) << what;
  EXPECT_LE(std::abs(value - expected), tolerance * std::max(1.0, std::abs(expected)))
      << what << ": " << value << " instead of " << expected;
}

/// A function that gives the derivative of an order (0: the value) of a scalar at t.
using Function = std::function<double(int order, double t)>;

inline Function sine() {
  return [](int order, double t) { return std::sin(t + order * std::acos(-1.0) / 2); };
}

/// Samples one function for each joint at knots, with or without velocities and accelerations.
inline MotionTable sample(const std::vector<double>& times, const std::vector<Function>& joints,
                          bool velocities, bool accelerations) {
  MotionTable table;
  table.times = times;
  const auto rows = static_cast<Eigen::Index>(times.size());
  const auto columns = static_cast<Eigen::Index>(joints.size());
  table.positions.resize(rows, columns);
  if (velocities) table.velocities.resize(rows, columns);
  if (accelerations) table.accelerations.resize(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    const Function& joint = joints[static_cast<std::size_t>(j)];
    table.joints.push_back("joint_" + std::to_string(j + 1));
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = times[static_cast<std::size_t>(i)];
      table.positions(i, j) = joint(0, t);
      if (velocities) table.velocities(i, j) = joint(1, t);
      if (accelerations) table.accelerations(i, j) = joint(2, t);
    }
  }
  return table;
}

constexpr std::size_t kQuinticSamples = 6;

/// Derivatives 0 to 5 at `t` of the quintic through six samples of `value` between `t` and `other`:
/// Newton's divided differences, which share nothing with Hermite's form.
inline std::array<double, kQuinticSamples> oneSided(const std::function<double(double)>& value,
                                                    double t, double other) {
  std::array<long double, kQuinticSamples> x;
  std::array<long double, kQuinticSamples> difference;
  for (std::size_t i = 0; i < kQuinticSamples; ++i) {
    // Samples are inside of the piece, as a value at the knot itself belongs to both sides.
    const double time = t + (other - t) * (static_cast<double>(i) + 0.5) / kQuinticSamples;
    x[i] = static_cast<long double>(time) - t;
    difference[i] = value(time);
  }
  for (std::size_t level = 1; level < kQuinticSamples; ++level) {
    for (std::size_t i = kQuinticSamples - 1; i >= level; --i) {
      difference[i] = (difference[i] - difference[i - 1]) / (x[i] - x[i - level]);
    }
  }
  // Newton's form becomes powers of the time relative to t.
  std::array<long double, kQuinticSamples> power{};
  for (std::size_t i = kQuinticSamples; i-- > 0;) {
    for (std::size_t k = kQuinticSamples - 1; k > 0; --k) power[k] = power[k - 1] - x[i] * power[k];
    power[0] = difference[i] - x[i] * power[0];
  }
  std::array<double, kQuinticSamples> derivatives;
  long double factorial = 1;
  for (std::size_t k = 0; k < kQuinticSamples; ++k) {
    if (k > 0) factorial *= static_cast<long double>(k);
    derivatives[k] = static_cast<double>(factorial * power[k]);
  }
  return derivatives;
}

}  // namespace spline_oracles
}  // namespace virtual_work_dynamics
