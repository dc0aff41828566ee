#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "spline_oracles.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using spline_oracles::expectClose;
using spline_oracles::Function;
using spline_oracles::oneSided;
using spline_oracles::sample;
using spline_oracles::sine;

// Closed forms with values of order 1 to 100 and steps of 0.2 to 1 s: rounding of the data (1e-16),
// amplified by up to 60 / 0.2^2 in the second derivative.
constexpr double kClosedForm = 1e-12;
// One-sided derivatives from six samples in a piece of 0.2 s or more: rounding of the samples,
// amplified by 1e3 / h^k in the k-th derivative, k <= 3.
constexpr double kOneSided = 1e-9;

/// c[0] + c[1] t + …, and its derivatives.
struct Polynomial {
  std::vector<long double> c;

  long double derivative(int order, long double t) const {
    long double sum = 0;
    for (int k = static_cast<int>(c.size()) - 1; k >= order; --k) {
      long double factor = 1;
      for (int i = 0; i < order; ++i) factor *= k - i;
      sum = sum * t + factor * c[static_cast<std::size_t>(k)];
    }
    return sum;
  }
};

std::vector<Function> randomPolynomials(int degree, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Function> functions;
  for (int j = 0; j < count; ++j) {
    Polynomial polynomial;
    for (int k = 0; k <= degree; ++k) polynomial.c.push_back(uniform(random));
    functions.push_back([polynomial](int order, double t) {
      return static_cast<double>(polynomial.derivative(order, t));
    });
  }
  return functions;
}

VectorXd atTime(const std::vector<Function>& functions, int order, double t) {
  VectorXd values(static_cast<Index>(functions.size()));
  for (Index j = 0; j < values.size(); ++j) {
    values[j] = functions[static_cast<std::size_t>(j)](order, t);
  }
  return values;
}

const std::vector<double>& unevenTimes() {
  static const std::vector<double> times = {-1.0, -0.6, -0.4, 0.3, 1.3, 1.9};
  return times;
}

void expectReproduced(const Spline& spline, const std::vector<Function>& functions) {
  Motion motion;
  for (int step = 0; step <= 290; ++step) {
    const double t = std::min(-1.0 + 0.01 * step, spline.endTime());
    spline.evaluate(t, motion);
    for (std::size_t j = 0; j < functions.size(); ++j) {
      const Index column = static_cast<Index>(j);
      const std::string where = "joint " + std::to_string(j) + " at " + std::to_string(t);
      expectClose(motion.q[column], functions[j](0, t), kClosedForm, "q of " + where);
      expectClose(motion.qd[column], functions[j](1, t), kClosedForm, "qd of " + where);
      expectClose(motion.qdd[column], functions[j](2, t), kClosedForm, "qdd of " + where);
    }
  }
}

std::function<double(double)> position(const Spline& spline) {
  return [&spline](double t) {
    Motion motion;
    spline.evaluate(t, motion);
    return motion.q[0];
  };
}

/// Both sides of every inner knot agree in the derivatives 0 … `order`, and with evaluate().
void expectContinuous(const Spline& spline, std::size_t order) {
  const std::vector<double>& times = spline.knots().times;
  Motion motion;
  for (std::size_t i = 1; i + 1 < times.size(); ++i) {
    const auto before = oneSided(position(spline), times[i], times[i - 1]);
    const auto after = oneSided(position(spline), times[i], times[i + 1]);
    const std::string where = " at knot " + std::to_string(i + 1);
    for (std::size_t k = 0; k <= order; ++k) {
      expectClose(before[k], after[k], kOneSided, "derivative " + std::to_string(k) + where);
    }
    spline.evaluate(times[i], motion);
    expectClose(motion.q[0], after[0], kOneSided, "q" + where);
    expectClose(motion.qd[0], after[1], kOneSided, "qd" + where);
    expectClose(motion.qdd[0], after[2], kOneSided, "qdd" + where);
  }
}

std::vector<double> evenTimes(int pieces, double start, double end) {
  std::vector<double> times;
  for (int i = 0; i <= pieces; ++i) times.push_back(start + (end - start) * i / pieces);
  return times;
}

struct Errors {
  double q = 0;
  double qdd_inside = 0;  ///< away from the ends
};

/// Largest errors of the spline through `pieces` + 1 samples of the sine on [0.3, 3.3].
Errors sineErrors(int pieces, bool velocities, bool accelerations) {
  const std::vector<Function> joints = {sine()};
  const Spline spline(sample(evenTimes(pieces, 0.3, 3.3), joints, velocities, accelerations),
                      atTime(joints, 1, 0.3), atTime(joints, 1, 3.3));
  Errors errors;
  Motion motion;
  for (int step = 0; step <= 3000; ++step) {
    const double t = std::min(0.3 + 0.001 * step, spline.endTime());
    spline.evaluate(t, motion);
    EXPECT_TRUE(motion.q.allFinite() && motion.qd.allFinite() && motion.qdd.allFinite());
    errors.q = std::max(errors.q, std::abs(motion.q[0] - joints[0](0, t)));
    if (step < 1000 || step > 2000) continue;
    errors.qdd_inside = std::max(errors.qdd_inside, std::abs(motion.qdd[0] - joints[0](2, t)));
  }
  return errors;
}

// --- reproduction of polynomials --------------------------------------------------------------

TEST(Spline, ReproducesQuinticsFromFullKnots) {
  const auto functions = randomPolynomials(5, 3);
  expectReproduced(Spline(sample(unevenTimes(), functions, true, true)), functions);
}

TEST(Spline, ReproducesCubicsFromPositionsAndVelocities) {
  const auto functions = randomPolynomials(3, 3);
  expectReproduced(Spline(sample(unevenTimes(), functions, true, false)), functions);
}

TEST(Spline, ReproducesCubicsFromPositionsAndEndVelocities) {
  const auto functions = randomPolynomials(3, 3);
  expectReproduced(Spline(sample(unevenTimes(), functions, false, false),
                          atTime(functions, 1, unevenTimes().front()),
                          atTime(functions, 1, unevenTimes().back())),
                   functions);
}

// --- continuity and convergence ---------------------------------------------------------------

TEST(Spline, CubicIsTwiceContinuouslyDifferentiable) {
  const std::vector<Function> joints = {sine()};
  expectContinuous(Spline(sample(unevenTimes(), joints, false, false)), 2);
}

TEST(Spline, QuinticIsThreeTimesContinuouslyDifferentiable) {
  const std::vector<Function> joints = {sine()};
  const Spline spline(sample(unevenTimes(), joints, true, false));
  expectContinuous(spline, 3);
  const std::size_t last = unevenTimes().size() - 1;
  const auto start = oneSided(position(spline), unevenTimes()[0], unevenTimes()[1]);
  const auto end = oneSided(position(spline), unevenTimes()[last], unevenTimes()[last - 1]);
  expectClose(start[4], 0, 100 * kOneSided, "fourth derivative at the start");
  expectClose(end[4], 0, 100 * kOneSided, "fourth derivative at the end");
}

TEST(Spline, FullKnotsAreTwiceContinuouslyDifferentiable) {
  MotionTable table = sample(unevenTimes(), {sine()}, true, true);
  table.velocities.array() += 0.3;  // no sine any more: a jump in the third derivative
  expectContinuous(Spline(table), 2);
}

// Order p: halving the step divides the error by 2^p, within 15 % at these steps.
constexpr double kOrderSlack = 0.15;

TEST(Spline, CubicConvergesWithFourthOrder) {
  const double ratio = sineErrors(20, false, false).q / sineErrors(40, false, false).q;
  EXPECT_NEAR(ratio, 16, 16 * kOrderSlack);
}

TEST(Spline, QuinticHermiteConvergesWithSixthOrder) {
  const double ratio = sineErrors(6, true, true).q / sineErrors(12, true, true).q;
  EXPECT_NEAR(ratio, 64, 64 * kOrderSlack);
}

TEST(Spline, AccelerationsFromVelocitiesConvergeWithFourthOrder) {
  const double ratio =
      sineErrors(40, true, false).qdd_inside / sineErrors(80, true, false).qdd_inside;
  EXPECT_NEAR(ratio, 16, 16 * kOrderSlack);
}

TEST(Spline, LongTrajectories) {
  constexpr int kPieces = 100000;
  // 100 s of sine at 1 kHz: the cubic's acceleration is off by h^2/12 of the fourth derivative, and
  // by rounding of the positions (1.1e-16) times 6/h^2.
  constexpr double kCubicAcceleration = 1e-7;
  const std::vector<Function> joints = {sine()};
  const Spline spline(sample(evenTimes(kPieces, 0, 100), joints, false, false),
                      atTime(joints, 1, 0), atTime(joints, 1, 100));
  Motion motion;
  for (int step = 0; step < 1000; ++step) {
    const double t = 0.1 * step + 0.0437;
    spline.evaluate(t, motion);
    expectClose(motion.q[0], joints[0](0, t), 1e-13, "q");
    expectClose(motion.qdd[0], joints[0](2, t), kCubicAcceleration, "qdd");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
