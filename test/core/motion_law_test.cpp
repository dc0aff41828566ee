#include "virtual_work_dynamics/motion_law.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "spline_oracles.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using spline_oracles::expectClose;
using spline_oracles::oneSided;

const double kPi = std::acos(-1.0);
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Closed forms of order 1 to 1000 evaluated in another order.
constexpr double kClosedForm = 1e-12;
// Derivative by central differences of five points, step 1e-3 s: truncation h^4/30 of the fifth
// derivative (up to (2 pi 3)^5 = 2e6 here) and rounding 1e-16/h.
constexpr double kDifference = 1e-6;
// One-sided derivatives from six samples in a piece of 0.5 s or more: rounding of the samples,
// amplified by 1e4 / h^k in the k-th derivative, k <= 4.
constexpr double kOneSided = 1e-9;

using Part = VectorXd Motion::*;

/// A part of the motion of coordinate j as a function of time.
std::function<double(double)> part(const MotionLaw& law, Part which, Index j) {
  return [&law, which, j](double t) {
    Motion motion;
    law.evaluate(t, motion);
    return (motion.*which)[j];
  };
}

double centralDifference(const std::function<double(double)>& f, double t) {
  constexpr double kStep = 1e-3;
  return (8 * (f(t + kStep) - f(t - kStep)) - (f(t + 2 * kStep) - f(t - 2 * kStep))) / (12 * kStep);
}

void expectDerivativesOfEachOther(const MotionLaw& law) {
  for (int step = 1; step < 50; ++step) {
    const double t = law.duration() * step / 50;
    for (Index j = 0; j < law.coordinates(); ++j) {
      expectClose(part(law, &Motion::qd, j)(t), centralDifference(part(law, &Motion::q, j), t),
                  kDifference, "qd");
      expectClose(part(law, &Motion::qdd, j)(t), centralDifference(part(law, &Motion::qd, j), t),
                  kDifference, "qdd");
    }
  }
}

void expectRefused(const std::function<void()>& make, const std::string& part_of_message) {
  try {
    make();
    ADD_FAILURE() << "not refused: " << part_of_message;
  } catch (const MotionError& error) {
    EXPECT_NE(std::string(error.what()).find(part_of_message), std::string::npos) << error.what();
  }
}

// --- cosine and sine sweep --------------------------------------------------------------------

TEST(MotionLaw, CosineIsThePapersLaw) {
  const auto law = cosineLaw(Vector2d(kPi / 12, kPi / 6), 12, 6);
  EXPECT_EQ(law->coordinates(), 2);
  EXPECT_EQ(law->duration(), 6);
  const long double pi = std::acos(-1.0L);
  Motion motion;
  for (int step = 0; step <= 600; ++step) {
    const double t = 0.01 * step;
    law->evaluate(t, motion);
    for (Index j = 0; j < 2; ++j) {
      // (5.11)
      const long double amplitude = j == 0 ? pi / 12 : pi / 6;
      const auto q = static_cast<double>(amplitude * (1 - std::cos(pi / 6 * t)));
      const auto qd = static_cast<double>(amplitude * pi / 6 * std::sin(pi / 6 * t));
      const auto qdd = static_cast<double>(amplitude * pi * pi / 36 * std::cos(pi / 6 * t));
      expectClose(motion.q[j], q, kClosedForm, "q");
      expectClose(motion.qd[j], qd, kClosedForm, "qd");
      expectClose(motion.qdd[j], qdd, kClosedForm, "qdd");
    }
  }
}

TEST(MotionLaw, CosineDoesNotCancelNearZero) {
  const auto law = cosineLaw(VectorXd::Constant(1, 1), 2 * kPi, 1);
  Motion motion;
  law->evaluate(1e-9, motion);
  EXPECT_NEAR(motion.q[0], 5e-19, 5e-19 * kClosedForm);
}

TEST(MotionLaw, CosineTakesItsPeriod) {
  expectDerivativesOfEachOther(*cosineLaw(Vector2d(0.4, -1.5), 0.8, 3));
  const auto law = cosineLaw(VectorXd::Constant(1, 0.5), 0.8, 3);
  Motion motion;
  law->evaluate(0.4, motion);
  expectClose(motion.q[0], 1, kClosedForm, "half a period: twice the amplitude");
  law->evaluate(0.8, motion);
  expectClose(motion.q[0], 0, kClosedForm, "a whole period");
}

TEST(MotionLaw, SweepOfOneFrequencyIsASine) {
  const auto law = sineSweepLaw(VectorXd::Constant(1, 0.7), 1.5, 1.5, 4);
  Motion motion;
  for (int step = 0; step <= 400; ++step) {
    const double t = 0.01 * step;
    law->evaluate(t, motion);
    const double rate = 3 * kPi;
    // Rounding of the phase, up to 38 rad.
    expectClose(motion.q[0], 0.7 * std::sin(rate * t), 10 * kClosedForm, "q");
    expectClose(motion.qd[0], 0.7 * rate * std::cos(rate * t), 10 * kClosedForm, "qd");
    expectClose(motion.qdd[0], -0.7 * rate * rate * std::sin(rate * t), 10 * kClosedForm, "qdd");
  }
}

TEST(MotionLaw, SweepRunsFromStartToEndFrequency) {
  // 1 Hz to 3 Hz in 2 s: four cycles; half way, at 2 Hz, 1.5 cycles are done.
  const auto law = sineSweepLaw(Vector2d(0.7, -2), 1, 3, 2);
  EXPECT_EQ(law->duration(), 2);
  expectDerivativesOfEachOther(*law);
  Motion motion;
  const double expected[3][2] = {{0, 2 * kPi}, {1, -4 * kPi}, {2, 6 * kPi}};  // t, qd / amplitude
  for (const auto& row : expected) {
    law->evaluate(row[0], motion);
    expectClose(motion.q[0], 0, kClosedForm, "q");
    expectClose(motion.qd[0], 0.7 * row[1], kClosedForm, "qd of the first");
    expectClose(motion.qd[1], -2 * row[1], kClosedForm, "qd of the second");
  }
}

TEST(MotionLaw, RefusesBadPeriodsFrequenciesAndDurations) {
  const VectorXd one = VectorXd::Ones(1);
  expectRefused([&] { cosineLaw(one, 0, 1); }, "the period of the cosine law must be positive, is");
  expectRefused([&] { cosineLaw(one, -2.5, 1); }, "is -2.5");
  expectRefused([&] { cosineLaw(one, 1, 0); }, "the duration of the cosine law");
  expectRefused([&] { cosineLaw(one, 1, kInfinity); }, "the duration of the cosine law");
  expectRefused([&] { cosineLaw(one, std::nan(""), 1); }, "the period of the cosine law");
  expectRefused([&] { cosineLaw(one * kInfinity, 1, 1); }, "amplitude 1 is not finite");
  expectRefused([&] { sineSweepLaw(one, -0.5, 1, 1); },
                "the start frequency of the sine sweep must not be negative, is -0.5");
  expectRefused([&] { sineSweepLaw(one, 1, -3, 1); }, "the end frequency of the sine sweep");
  expectRefused([&] { sineSweepLaw(one, 1, 2, 0); }, "the duration of the sine sweep");
  expectRefused([&] { sineSweepLaw(one * kInfinity, 1, 2, 1); }, "amplitude 1 is not finite");
}

// --- minimum jerk -----------------------------------------------------------------------------

MotionTable viaPoints() {
  MotionTable table;
  table.joints = {"joint_1", "joint_2"};
  table.times = {0, 1, 1.5, 3, 4};
  table.positions.resize(5, 2);
  table.positions << 0, 0.3, 1, -0.4, 0.2, 0.9, -1, 0.7, 0.5, 0.1;
  return table;
}

/// Velocities and accelerations of a law at the times of the table.
MotionTable completed(MotionTable table, const MotionLaw& law) {
  table.velocities.resize(table.positions.rows(), table.positions.cols());
  table.accelerations.resize(table.positions.rows(), table.positions.cols());
  Motion motion;
  for (Index i = 0; i < table.positions.rows(); ++i) {
    law.evaluate(table.times[static_cast<std::size_t>(i)], motion);
    table.velocities.row(i) = motion.qd.transpose();
    table.accelerations.row(i) = motion.qdd.transpose();
  }
  return table;
}

/// Integral of the squared jerk of coordinate j. On a piece the acceleration is a cubic, so four
/// samples give it by Lagrange's formula, its slope is exact, and three Gauss points suffice.
double jerkCost(const MotionTable& knots, Index j) {
  const Spline spline(knots);
  const double nodes[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  const double weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  Motion motion;
  double cost = 0;
  for (std::size_t i = 0; i + 1 < knots.times.size(); ++i) {
    const double h = knots.times[i + 1] - knots.times[i];
    std::array<double, 4> s = {0.1, 0.35, 0.65, 0.9};
    std::array<double, 4> acceleration;
    for (std::size_t k = 0; k < 4; ++k) {
      spline.evaluate(knots.times[i] + s[k] * h, motion);
      acceleration[k] = motion.qdd[j];
    }
    for (std::size_t g = 0; g < 3; ++g) {
      double jerk = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        double slope = 0;
        for (std::size_t m = 0; m < 4; ++m) {
          if (m == k) continue;
          double term = 1 / (s[k] - s[m]);
          for (std::size_t n = 0; n < 4; ++n) {
            if (n != k && n != m) term *= (nodes[g] - s[n]) / (s[k] - s[n]);
          }
          slope += term;
        }
        jerk += acceleration[k] * slope / h;
      }
      cost += weights[g] * h * jerk * jerk;
    }
  }
  return cost;
}

TEST(MotionLaw, MinimumJerkFromPointToPoint) {
  MotionTable table;
  table.times = {2, 5};
  table.positions = (MatrixXd(2, 1) << 1, 5).finished();
  const auto law = minimumJerkLaw(table);
  EXPECT_EQ(law->duration(), 3);
  EXPECT_EQ(law->coordinates(), 1);
  Motion motion;
  for (int step = 0; step <= 30; ++step) {
    const double t = 0.1 * step;
    const double s = t / 3;
    law->evaluate(t, motion);
    const double q = 1 + 4 * (10 * std::pow(s, 3) - 15 * std::pow(s, 4) + 6 * std::pow(s, 5));
    const double qd = 4 * (30 * std::pow(s, 2) - 60 * std::pow(s, 3) + 30 * std::pow(s, 4)) / 3;
    const double qdd = 4 * (60 * s - 180 * std::pow(s, 2) + 120 * std::pow(s, 3)) / 9;
    expectClose(motion.q[0], q, kClosedForm, "q");
    expectClose(motion.qd[0], qd, kClosedForm, "qd");
    expectClose(motion.qdd[0], qdd, kClosedForm, "qdd");
  }
}

TEST(MotionLaw, MinimumJerkPassesItsPointsFromRestToRest) {
  const MotionTable points = viaPoints();
  const auto law = minimumJerkLaw(points);
  Motion motion;
  for (Index i = 0; i < 5; ++i) {
    law->evaluate(points.times[static_cast<std::size_t>(i)], motion);
    EXPECT_EQ(motion.q, points.positions.row(i).transpose());
    if (i != 0 && i != 4) continue;
    EXPECT_EQ(motion.qd, Vector2d::Zero());
    EXPECT_EQ(motion.qdd, Vector2d::Zero());
  }
}

TEST(MotionLaw, MinimumJerkIsFourTimesContinuouslyDifferentiable) {
  const MotionTable points = viaPoints();
  const auto law = minimumJerkLaw(points);
  for (Index j = 0; j < 2; ++j) {
    const auto q = part(*law, &Motion::q, j);
    for (std::size_t i = 1; i + 1 < points.times.size(); ++i) {
      const auto before = oneSided(q, points.times[i], points.times[i - 1]);
      const auto after = oneSided(q, points.times[i], points.times[i + 1]);
      for (std::size_t k = 0; k <= 4; ++k) {
        expectClose(before[k], after[k], kOneSided, "derivative " + std::to_string(k));
      }
    }
  }
}

TEST(MotionLaw, MinimumJerkIsTheMinimum) {
  const MotionTable points = viaPoints();
  const auto law = minimumJerkLaw(points);
  const MotionTable best = completed(points, *law);
  constexpr double kStep = 1e-3;
  // The cost is quadratic: at its minimum the slope is zero, up to rounding of the cost (1e-13 of
  // it), which the rise at this step exceeds a thousand times.
  constexpr double kSlope = 1e-3;
  for (Index j = 0; j < 2; ++j) {
    const double cost = jerkCost(best, j);
    ASSERT_GT(cost, 0);
    for (Index i = 1; i < 4; ++i) {
      for (const auto values : {&MotionTable::velocities, &MotionTable::accelerations}) {
        MotionTable more = best;
        MotionTable less = best;
        (more.*values)(i, j) += kStep;
        (less.*values)(i, j) -= kStep;
        const double rise = jerkCost(more, j) - cost;
        const double fall = jerkCost(less, j) - cost;
        EXPECT_GT(rise, 0);
        EXPECT_GT(fall, 0);
        EXPECT_LE(std::abs(rise - fall), kSlope * (rise + fall));
      }
    }
  }
}

TEST(MotionLaw, MinimumJerkOfTheTwoPointLawIsThatLaw) {
  // Points on the one minimum between two points: the motion through them is the same motion.
  MotionTable table;
  table.times = {0, 0.3, 0.5, 0.9, 1};
  table.positions.resize(5, 1);
  for (Index i = 0; i < 5; ++i) {
    const double s = table.times[static_cast<std::size_t>(i)];
    table.positions(i, 0) = s * s * s * (10 - 15 * s + 6 * s * s);
  }
  const auto law = minimumJerkLaw(table);
  Motion motion;
  for (int step = 0; step <= 100; ++step) {
    const double s = 0.01 * step;
    law->evaluate(s, motion);
    expectClose(motion.q[0], s * s * s * (10 - 15 * s + 6 * s * s), kClosedForm, "q");
    expectClose(motion.qdd[0], 60 * s * (1 - s) * (1 - 2 * s), 100 * kClosedForm, "qdd");
  }
}

TEST(MotionLaw, MinimumJerkRefusesBadPoints) {
  MotionTable table = viaPoints();
  table.times[2] = 0.5;
  expectRefused([&] { minimumJerkLaw(table); }, "knot 3: the time 0.5 s does not come after 1 s");
  table = viaPoints();
  table.positions(1, 0) = std::nan("");
  expectRefused([&] { minimumJerkLaw(table); }, "knot 2: the position of joint joint_1");
  table = viaPoints();
  table.times.resize(1);
  table.positions.conservativeResize(1, 2);
  expectRefused([&] { minimumJerkLaw(table); }, "at least two via points, got 1");
}

// --- table ------------------------------------------------------------------------------------

TEST(MotionLaw, TableStartsAtZeroAndIsExactAtItsRows) {
  MotionTable table = viaPoints();
  for (double& time : table.times) time += 16;  // a power of two: exact
  table.velocities = 0.3 * table.positions.array() + 1;
  table.accelerations = 2 - table.positions.array();
  const auto law = tableLaw(table);
  EXPECT_EQ(law->duration(), 4);
  EXPECT_EQ(law->coordinates(), 2);
  Motion motion;
  for (Index i = 0; i < 5; ++i) {
    law->evaluate(viaPoints().times[static_cast<std::size_t>(i)], motion);
    EXPECT_EQ(motion.q, table.positions.row(i).transpose());
    EXPECT_EQ(motion.qd, table.velocities.row(i).transpose());
    EXPECT_EQ(motion.qdd, table.accelerations.row(i).transpose());
  }
}

TEST(MotionLaw, TableIsTheSplineBetweenItsRows) {
  MotionTable table = viaPoints();
  table.velocities = 0.3 * table.positions.array() + 1;
  const auto law = tableLaw(table);
  const Spline spline(table);
  Motion motion;
  Motion expected;
  for (int step = 0; step <= 40; ++step) {
    law->evaluate(0.1 * step, motion);
    spline.evaluate(0.1 * step, expected);
    EXPECT_EQ(motion.q, expected.q);
    EXPECT_EQ(motion.qdd, expected.qdd);
  }
}

TEST(MotionLaw, TableRefusesNoRows) {
  expectRefused([] { tableLaw(MotionTable()); }, "at least one knot");
}

}  // namespace
}  // namespace virtual_work_dynamics
