#include "motion/polynomial_fit.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Published weights and closed forms hold except for a few roundings.
constexpr double kIdentity = 50 * kEpsilon;
// Errors of the samples and the weights, in units of the sum of |weight * sample|: a rounding for
// each of the steps of the orthogonalization, which has up to 256 rows.
constexpr double kRounding = 300 * kEpsilon;

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

struct Estimate {
  double derivative[3];
};

Estimate evaluate(const PolynomialFit& fit, const std::vector<double>& q, const double* qd) {
  Estimate result;
  fit.evaluate(q.data(), qd, result.derivative[0], result.derivative[1], result.derivative[2]);
  return result;
}

/// The weight of each position sample in the d-th derivative, by asking for unit samples.
std::vector<double> positionWeights(const PolynomialFit& fit, int window, int d) {
  std::vector<double> weights;
  for (int i = 0; i < window; ++i) {
    std::vector<double> unit(static_cast<std::size_t>(window), 0.0);
    unit[static_cast<std::size_t>(i)] = 1;
    weights.push_back(evaluate(fit, unit, nullptr).derivative[d]);
  }
  return weights;
}

/// Times around an instant at zero, spacing about h, each moved by up to 35 % of it.
std::vector<double> unevenTimes(int window, int lag, double h, std::mt19937& random) {
  std::uniform_real_distribution<double> jitter(-0.35, 0.35);
  std::vector<double> times;
  for (int i = 0; i < window; ++i) times.push_back(h * (i - (window - 1 - lag) + jitter(random)));
  return times;
}

/// Weights (3 x samples) by a pivoting QR factorization of plain powers of time, in long double.
LongMatrix referenceWeights(const std::vector<double>& times, int order, bool velocities) {
  const auto window = static_cast<Eigen::Index>(times.size());
  const long double span = times.back() - times.front();
  const long double spacing = span / static_cast<long double>(window - 1);
  LongMatrix A = LongMatrix::Zero(velocities ? 2 * window : window, order + 1);
  for (Eigen::Index i = 0; i < window; ++i) {
    const long double x = times[static_cast<std::size_t>(i)] / span;
    for (int k = 0; k <= order; ++k) {
      A(i, k) = std::pow(x, static_cast<long double>(k));
      if (velocities && k > 0)
        A(window + i, k) = spacing / span * k * std::pow(x, static_cast<long double>(k - 1));
    }
  }
  const LongMatrix all = A.colPivHouseholderQr().solve(LongMatrix::Identity(A.rows(), A.rows()));
  LongMatrix weights = LongMatrix::Zero(3, A.rows());
  weights.row(0) = all.row(0);
  weights.row(1) = all.row(1) / span;
  if (order > 1) weights.row(2) = 2 * all.row(2) / (span * span);
  if (velocities) weights.rightCols(window) *= spacing;
  return weights;
}

template <typename Check>
void forEachShape(const Check& check) {
  std::mt19937 random(11);
  for (int order = 1; order <= PolynomialFit::kMaxOrder; ++order)
    for (const int window : {order + 1, order + 2, 9, 33, PolynomialFit::kMaxWindow})
      for (const int lag : {0, window / 2, window - 1})
        for (const double h : {1e-3, 0.1})
          for (const bool velocities : {false, true}) {
            SCOPED_TRACE("order " + std::to_string(order) + " window " + std::to_string(window) +
                         " lag " + std::to_string(lag) + " spacing " + std::to_string(h) +
                         (velocities ? " with velocities" : ""));
            check(unevenTimes(window, lag, h, random), order, velocities, random);
          }
}

}  // namespace

TEST(PolynomialFit, HasThePublishedWeightsOfSavitzkyAndGolay) {
  const double h = 1e-3;
  std::vector<double> times;
  for (int i = -4; i <= 4; ++i) times.push_back(i * h);
  const std::vector<std::vector<double>> published = {{-21, 14, 39, 54, 59, 54, 39, 14, -21},
                                                      {86, -142, -193, -126, 0, 126, 193, 142, -86},
                                                      {28, 7, -8, -17, -20, -17, -8, 7, 28}};
  const double divisors[] = {231, 1188, 462};
  PolynomialFit fit;
  fit.fit(times.data(), 9, 3, false);
  for (int d = 0; d < 3; ++d) {
    const std::vector<double> weights = positionWeights(fit, 9, d);
    for (std::size_t i = 0; i < 9; ++i) {
      const double weight = weights[i] * std::pow(h, d);
      ASSERT_TRUE(std::isfinite(weight));
      EXPECT_NEAR(weight, published[static_cast<std::size_t>(d)][i] / divisors[d], kIdentity)
          << "derivative " << d << " sample " << i;
    }
  }
}

TEST(PolynomialFit, WeighsVelocitiesByTheMeanSpacing) {
  // Minimum of sum (a + b t - q)^2 + h^2 sum (b - qd)^2 over two samples, by hand.
  const double h = 0.02;
  const double times[] = {-h / 2, h / 2};
  const std::vector<double> q = {0.3, 0.7};
  const double qd[] = {11, -4};
  PolynomialFit fit;
  fit.fit(times, 2, 1, true);
  const Estimate result = evaluate(fit, q, qd);
  const double slope = ((q[1] - q[0]) / (2 * h) + qd[0] + qd[1]) / 2.5;
  EXPECT_NEAR(result.derivative[0], 0.5, kIdentity);
  EXPECT_NEAR(result.derivative[1], slope, kIdentity * slope);
  EXPECT_EQ(result.derivative[2], 0);
}

TEST(PolynomialFit, ReproducesPolynomialsOfItsOrder) {
  forEachShape([](const std::vector<double>& times, int order, bool velocities, auto& random) {
    std::uniform_real_distribution<double> coefficient(-1, 1);
    std::vector<long double> c;
    for (int k = 0; k <= order; ++k) c.push_back(coefficient(random));
    const long double span = times.back() - times.front();
    std::vector<double> q;
    std::vector<double> qd;
    for (const double t : times) {
      const long double x = t / span;
      long double value = 0;
      long double slope = 0;
      for (int k = order; k >= 0; --k) {
        slope = slope * x + value;
        value = value * x + c[static_cast<std::size_t>(k)];
      }
      q.push_back(static_cast<double>(value));
      qd.push_back(static_cast<double>(slope / span));
    }
    const auto window = static_cast<int>(times.size());
    PolynomialFit fit;
    fit.fit(times.data(), window, order, velocities);
    const Estimate result = evaluate(fit, q, velocities ? qd.data() : nullptr);

    const long double expected[] = {c[0], c[1] / span, order > 1 ? 2 * c[2] / (span * span) : 0};
    const LongMatrix weights = referenceWeights(times, order, velocities);
    for (int d = 0; d < 3; ++d) {
      long double size = 0;
      for (int i = 0; i < window; ++i) {
        size += std::abs(weights(d, i)) * (1 + order);  // |q| <= order + 1
        if (velocities) size += std::abs(weights(d, window + i) * qd[static_cast<std::size_t>(i)]);
      }
      ASSERT_TRUE(std::isfinite(result.derivative[d]));
      EXPECT_NEAR(result.derivative[d], static_cast<double>(expected[d]),
                  kRounding * static_cast<double>(size) + kEpsilon * std::abs(result.derivative[d]))
          << "derivative " << d;
    }
  });
}

TEST(PolynomialFit, IsTheLeastSquaresFitOfAnySamples) {
  forEachShape([](const std::vector<double>& times, int order, bool velocities, auto& random) {
    const auto window = static_cast<int>(times.size());
    const double spacing = (times.back() - times.front()) / (window - 1);
    std::uniform_real_distribution<double> sample(-1, 1);
    std::vector<double> q(times.size());
    std::vector<double> qd(times.size());
    for (double& value : q) value = sample(random);
    for (double& value : qd) value = sample(random) / spacing;
    PolynomialFit fit;
    fit.fit(times.data(), window, order, velocities);
    const Estimate result = evaluate(fit, q, velocities ? qd.data() : nullptr);

    const LongMatrix weights = referenceWeights(times, order, velocities);
    for (int d = 0; d < 3; ++d) {
      long double expected = 0;
      long double size = 0;
      for (int i = 0; i < weights.cols(); ++i) {
        const double value =
            i < window ? q[static_cast<std::size_t>(i)] : qd[static_cast<std::size_t>(i - window)];
        expected += weights(d, i) * value;
        size += std::abs(weights(d, i)) * (i < window ? 2 : 1 / spacing);
      }
      ASSERT_TRUE(std::isfinite(result.derivative[d]));
      EXPECT_NEAR(result.derivative[d], static_cast<double>(expected),
                  kRounding * static_cast<double>(size))
          << "derivative " << d;
    }
  });
}

TEST(PolynomialFit, KeepsItsDigitsWhenSamplesComeInBursts) {
  // Eight samples within a thousandth of the window, as when a driver catches up after a pause.
  // Times that are known to eps of the window tell spacings of 1/7000 of it apart to 7000 eps.
  const double tolerance = 7000 * kEpsilon;
  std::mt19937 random(19);
  std::uniform_real_distribution<double> sample(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> times = {-0.1};
    for (int i = 0; i < 8; ++i) times.push_back(1e-4 * (i - 7) / 7 + 1e-6 * sample(random));
    std::vector<double> q(9);
    for (double& value : q) value = sample(random);
    PolynomialFit fit;
    fit.fit(times.data(), 9, 3, false);
    const Estimate result = evaluate(fit, q, nullptr);
    const LongMatrix weights = referenceWeights(times, 3, false);
    for (int d = 0; d < 3; ++d) {
      long double expected = 0;
      long double size = 0;
      for (int i = 0; i < 9; ++i) {
        expected += weights(d, i) * q[static_cast<std::size_t>(i)];
        size += std::abs(weights(d, i));
      }
      ASSERT_TRUE(std::isfinite(result.derivative[d]));
      EXPECT_NEAR(result.derivative[d], static_cast<double>(expected),
                  tolerance * static_cast<double>(size));
    }
  }
}

TEST(PolynomialFit, DerivativesDoNotDependOnAnOffsetOfThePositions) {
  std::mt19937 random(3);
  const std::vector<double> times = unevenTimes(9, 4, 1e-3, random);
  const double offset = 1 << 20;
  std::vector<double> near_zero;
  std::vector<double> far_away;
  for (int i = 0; i < 9; ++i) {
    near_zero.push_back(static_cast<double>(random() % 1024) / 1024);
    far_away.push_back(offset + near_zero.back());  // exact
  }
  PolynomialFit fit;
  fit.fit(times.data(), 9, 3, false);
  const Estimate here = evaluate(fit, near_zero, nullptr);
  const Estimate there = evaluate(fit, far_away, nullptr);
  EXPECT_NEAR(there.derivative[0], offset + here.derivative[0], kEpsilon * offset);
  EXPECT_EQ(there.derivative[1], here.derivative[1]);
  EXPECT_EQ(there.derivative[2], here.derivative[2]);
}

TEST(PolynomialFit, LeavesOutTermsThatTheTimesCannotTellApart) {
  // Eight samples as close together as numbers are, and one far off: only a line can be told.
  std::vector<double> times = {-1};
  for (int i = 0; i < 7; ++i) times.push_back(std::nextafter(times.back(), 0));
  times.push_back(0);
  std::vector<double> q(8, 3.0);
  q.push_back(5);
  PolynomialFit fit;
  fit.fit(times.data(), 9, 6, false);
  const Estimate result = evaluate(fit, q, nullptr);
  EXPECT_NEAR(result.derivative[0], 5, 5 * kIdentity);
  EXPECT_NEAR(result.derivative[1], 2, 2 * kIdentity);
  EXPECT_NEAR(result.derivative[2], 0, kIdentity);
}

TEST(PolynomialFit, RefusesArgumentsOutOfRangeByName) {
  PolynomialFit fit;
  std::vector<double> times(200);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i);
  const auto message = [&](int window, int order) -> std::string {
    try {
      fit.fit(times.data(), window, order, false);
    } catch (const MotionError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(9, 0), "polynomial fit: order is 0, must be from 1 to 6");
  EXPECT_EQ(message(9, 7), "polynomial fit: order is 7, must be from 1 to 6");
  EXPECT_EQ(message(3, 3), "polynomial fit: window is 3, must be from order + 1 = 4 to 128");
  EXPECT_EQ(message(129, 3), "polynomial fit: window is 129, must be from order + 1 = 4 to 128");
  EXPECT_EQ(message(128, 6), "accepted");
  EXPECT_EQ(message(7, 6), "accepted");
  times[5] = times[4];
  EXPECT_EQ(message(9, 3), "polynomial fit: time of sample 6 is not later than the one before");
  times[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message(9, 3), "polynomial fit: time of sample 6 is not finite");
}

}  // namespace virtual_work_dynamics
