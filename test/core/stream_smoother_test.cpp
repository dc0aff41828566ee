#include "motion/stream_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "integrated_noise.h"

namespace virtual_work_dynamics {
namespace {

using Real = long double;
using LongMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Real factorial(int n) {
  return n <= 1 ? 1 : n * factorial(n - 1);
}

/// Covariance of derivatives i and k of white noise of density one that is integrated `order` times
/// over `dt`: the integral of (dt-u)^p/p! (dt-u)^q/q! over u, by Gauss and Legendre with six nodes,
/// which is exact up to degree 11.
Real noiseCovariance(int order, Real dt, int i, int k) {
  constexpr std::array<Real, 6> kNodes{0.2386191860831969086305L, -0.2386191860831969086305L,
                                       0.6612093864662645136614L, -0.6612093864662645136614L,
                                       0.9324695142031520278123L, -0.9324695142031520278123L};
  constexpr std::array<Real, 6> kWeights{0.4679139345726910473899L, 0.4679139345726910473899L,
                                         0.3607615730481386075698L, 0.3607615730481386075698L,
                                         0.1713244923791703450403L, 0.1713244923791703450403L};
  const int p = order - 1 - i;
  const int q = order - 1 - k;
  Real integral = 0;
  for (std::size_t n = 0; n < kNodes.size(); ++n) {
    const Real rest = dt / 2 * (1 + kNodes[n]);
    integral += dt / 2 * kWeights[n] * std::pow(rest, p + q) / factorial(p) / factorial(q);
  }
  return integral;
}

/// The states of all rows of a stretch at once, as one least-squares problem: what is known of the
/// first row, of the steps between rows and of the measurements, each divided by its deviation.
class LeastSquares {
 public:
  LeastSquares(int order, std::size_t rows)
      : order_(order), columns_(static_cast<Eigen::Index>(rows) * order) {}

  /// Adds equations: coefficients of the state of `row` and of the one after it.
  void add(std::size_t row, const LongMatrix& here, const LongMatrix& next,
           const LongVector& value) {
    equations_.push_back({static_cast<Eigen::Index>(row) * order_, here, next, value});
    count_ += value.size();
  }

  void solve() {
    A_ = LongMatrix::Zero(count_, columns_);
    LongVector b(count_);
    Eigen::Index at = 0;
    for (const Equations& e : equations_) {
      A_.block(at, e.column, e.here.rows(), order_) = e.here;
      if (e.next.size() > 0) A_.block(at, e.column + order_, e.next.rows(), order_) = e.next;
      b.segment(at, e.value.size()) = e.value;
      at += e.value.size();
    }
    // Derivatives have units of their own, by which the rank must not be judged.
    const LongVector scale = A_.colwise().norm().cwiseInverse();
    A_ = A_ * scale.asDiagonal();
    const Eigen::ColPivHouseholderQR<LongMatrix> factors(A_);
    ASSERT_EQ(factors.rank(), columns_);
    solution_ = scale.asDiagonal() * LongVector(factors.solve(b));
    const LongMatrix R = factors.matrixR().topRows(columns_);
    const LongMatrix inverse =
        R.triangularView<Eigen::Upper>().solve(LongMatrix::Identity(columns_, columns_));
    root_ = scale.asDiagonal() * LongMatrix(factors.colsPermutation() * inverse);
  }

  SmoothedSample state(std::size_t row) const {
    const Eigen::Index column = static_cast<Eigen::Index>(row) * order_;
    SmoothedSample sample;
    sample.motion = solution_.segment(column, 3).cast<double>();
    const LongMatrix root = root_.middleRows(column, 3);
    sample.covariance = LongMatrix(root * root.transpose()).cast<double>();
    return sample;
  }

 private:
  struct Equations {
    Eigen::Index column;
    LongMatrix here, next;
    LongVector value;
  };

  int order_;
  Eigen::Index columns_;
  Eigen::Index count_ = 0;
  std::vector<Equations> equations_;
  LongMatrix A_, root_;
  LongVector solution_;
};

/// Estimates of rows begin … end - 1, between which there is no gap, from these rows alone.
std::vector<SmoothedSample> solved(const std::vector<StreamBlock>& samples, std::size_t begin,
                                   std::size_t end, const StreamModel& model, int order,
                                   double interval) {
  LeastSquares problem(order, end - begin);
  const auto measure = [&](std::size_t row, int derivative, double value, Real variance) {
    LongMatrix here = LongMatrix::Zero(1, order);
    here(0, derivative) = 1 / std::sqrt(variance);
    problem.add(row - begin, here, LongMatrix(),
                LongVector::Constant(1, value * here(0, derivative)));
  };
  // Of the derivatives in the first row: those of a polynomial through the rows of two time
  // constants, within ten deviations of these and what the noise does within many time constants.
  const double constant = timeConstant(model, order, interval);
  // … that leave the second position known to 1e5 deviations of a sample, at least.
  const Real time =
      std::min<Real>(100 * std::max(constant, interval),
                     std::pow(1e10 * model.position_variance / model.density / interval / interval,
                              1.0 / (2 * order - 3)));
  const auto rows = static_cast<Eigen::Index>(
      std::min(std::clamp(2 * constant / interval, order + 0.0, 64.0), 0.0 + end - begin));
  const Eigen::Index terms = std::min<Eigen::Index>(rows - 1, order - 1);
  LongMatrix powers(std::max<Eigen::Index>(rows - 1, 0), std::max<Eigen::Index>(terms, 0));
  LongVector positions(powers.rows());
  for (Eigen::Index k = 0; k < powers.rows(); ++k) {
    const StreamBlock& other = samples[begin + static_cast<std::size_t>(k) + 1];
    for (Eigen::Index i = 0; i < terms; ++i)
      powers(k, i) = std::pow(static_cast<Real>(other.time) - samples[begin].time, i + 1);
    positions[k] = other.position - samples[begin].position;
  }
  const LongMatrix inverse = LongMatrix(powers.transpose() * powers).inverse();
  const LongVector coefficients = inverse * powers.transpose() * positions;
  for (int i = 1; i < order; ++i) {
    const Real by_noise = model.density * std::pow(time, 2 * (order - i) - 1);
    if (i > terms) {
      measure(begin, i, 0, by_noise);
      continue;
    }
    const Real variance = 100 * model.position_variance * inverse(i - 1, i - 1);
    measure(begin, i, static_cast<double>(factorial(i) * coefficients[i - 1]),
            by_noise + factorial(i) * factorial(i) * variance);
  }
  for (std::size_t row = begin; row < end; ++row) {
    measure(row, 0, samples[row].position - samples[begin].position, model.position_variance);
    if (model.usesVelocities() && !std::isnan(samples[row].velocity))
      measure(row, 1, samples[row].velocity, model.velocity_variance);
    if (row + 1 == end) continue;
    const Real dt = static_cast<Real>(samples[row + 1].time) - samples[row].time;
    LongMatrix F = LongMatrix::Zero(order, order), Q(order, order);
    for (int i = 0; i < order; ++i)
      for (int k = 0; k < order; ++k) {
        if (k >= i) F(i, k) = std::pow(dt, k - i) / factorial(k - i);
        Q(i, k) = model.density * noiseCovariance(order, dt, i, k);
      }
    // Whitened by the factor of Q: L^-1 (x' - F x) = noise of deviation one.
    const LongMatrix L = Eigen::LLT<LongMatrix>(Q).matrixL();
    const LongMatrix whitening =
        L.triangularView<Eigen::Lower>().solve(LongMatrix::Identity(order, order));
    problem.add(row - begin, -whitening * F, whitening, LongVector::Zero(order));
  }
  problem.solve();
  std::vector<SmoothedSample> results;
  for (std::size_t row = begin; row < end; ++row) {
    results.push_back(problem.state(row - begin));
    results.back().motion[0] += samples[begin].position;
  }
  return results;
}

/// Each stretch between gaps by itself, each row from those up to `lag` after it.
std::vector<SmoothedSample> denseSmoother(const std::vector<StreamBlock>& samples,
                                          const StreamModel& model, int order, double interval,
                                          double longest_gap, double lag) {
  std::vector<SmoothedSample> results;
  std::size_t begin = 0;
  for (std::size_t end = 1; end <= samples.size(); ++end) {
    if (end < samples.size() && samples[end].time - samples[end - 1].time <= longest_gap) continue;
    for (std::size_t row = begin; row < end; ++row) {
      std::size_t last = row + 1;
      while (last < end && samples[last].time <= samples[row].time + lag) ++last;
      if (last == end) {  // what is left is estimated from the same rows
        const auto rest = solved(samples, begin, end, model, order, interval);
        results.insert(results.end(), rest.begin() + static_cast<std::ptrdiff_t>(row - begin),
                       rest.end());
        break;
      }
      results.push_back(solved(samples, begin, last, model, order, interval)[row - begin]);
    }
    begin = end;
  }
  return results;
}

std::vector<SmoothedSample> smoothed(const std::vector<StreamBlock>& samples,
                                     const StreamModel& model, int order, double interval,
                                     double longest_gap, double lag, bool covariance = true) {
  std::vector<SmoothedSample> results(samples.size());
  std::vector<int> taken(samples.size());
  smoothStream(samples, model, order, interval, longest_gap, lag, covariance,
               [&](std::size_t row, const SmoothedSample& sample) {
                 results[row] = sample;
                 ++taken[row];
               });
  for (const int count : taken) EXPECT_EQ(count, 1);
  return results;
}

// The recursion of the mean cancels digits where the covariance falls from that of next to no
// knowledge to that of the samples: by 1e10 in orders 4 to 6.
constexpr double kMeanTolerance = 1e-4;        // in deviations of the estimate
constexpr double kCovarianceTolerance = 1e-3;  // of the product of the deviations

void expectEqual(const std::vector<SmoothedSample>& actual,
                 const std::vector<SmoothedSample>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t row = 0; row < actual.size(); ++row) {
    ASSERT_TRUE(actual[row].motion.allFinite() && actual[row].covariance.allFinite());
    const Eigen::Vector3d deviation = expected[row].covariance.diagonal().cwiseSqrt();
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(actual[row].motion[i], expected[row].motion[i], kMeanTolerance * deviation[i])
          << "row " << row << ", derivative " << i;
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(actual[row].covariance(i, k), expected[row].covariance(i, k),
                    kCovarianceTolerance * deviation[i] * deviation[k])
            << "row " << row << ": " << i << ", " << k;
    }
  }
}

/// Uneven times about 10 ms apart, with a gap of 0.4 s after every 15 rows.
std::vector<double> unevenTimes(std::size_t rows) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> step(0.004, 0.016);
  std::vector<double> times{2};
  while (times.size() < rows)
    times.push_back(times.back() + (times.size() % 15 == 0 ? 0.4 : step(generator)));
  return times;
}

IntegratedNoise motionOf(int order) {
  IntegratedNoise motion;
  motion.order = order;
  motion.position_noise = 1e-3;
  motion.velocity_noise = 0.05;
  motion.density = densityFor(0.03, 1e-6, order, 0.01);
  return motion;
}

/// The motion that samples are taken of. The equations hold of any samples, and those of a motion
/// of order 6 become so large that their own digits run out.
IntegratedNoise movedBy(const IntegratedNoise& motion) {
  return motion.order < 6 ? motion : motionOf(5);
}

TEST(StreamSmoother, IsThePosteriorOfAGaussianProcess) {
  for (const int order : {3, 4, 5, 6})
    for (const bool velocities : {false, true})
      for (const double lag : {0.0, 0.03, kInfinity}) {
        SCOPED_TRACE("order " + std::to_string(order) + ", lag " + std::to_string(lag) +
                     (velocities ? ", velocities" : ""));
        const IntegratedNoise motion = motionOf(order);
        std::vector<StreamBlock> samples =
            movedBy(motion).samples(unevenTimes(45), static_cast<unsigned>(order));
        for (std::size_t i = 0; i < samples.size(); i += 7) samples[i].velocity = std::nan("");
        StreamModel model;
        model.density = motion.density;
        model.position_variance = std::pow(motion.position_noise, 2);
        model.velocity_variance = velocities ? std::pow(motion.velocity_noise, 2) : -1;
        expectEqual(smoothed(samples, model, order, 0.01, 0.25, lag),
                    denseSmoother(samples, model, order, 0.01, 0.25, lag));
      }
}

TEST(StreamSmoother, WithoutCovarianceTheMotionIsTheSame) {
  const IntegratedNoise motion = motionOf(4);
  const std::vector<StreamBlock> samples = motion.samples(unevenTimes(60), 1);
  StreamModel model;
  model.density = motion.density;
  model.position_variance = 1e-6;
  for (const double lag : {0.03, kInfinity}) {
    const auto with = smoothed(samples, model, 4, 0.01, 0.25, lag);
    const auto without = smoothed(samples, model, 4, 0.01, 0.25, lag, false);
    for (std::size_t row = 0; row < samples.size(); ++row) {
      EXPECT_EQ(with[row].motion, without[row].motion);
      EXPECT_TRUE(without[row].covariance.isZero(0));
    }
  }
}

// Of a motion played backwards the estimates are the same, played backwards, wherever the rows are
// divided into parts that are filtered twice; only what is assumed of the first row differs.
TEST(StreamSmoother, PlayedBackwardsALongRecordingIsTheSame) {
  for (const int order : {3, 4, 5, 6}) {
    const IntegratedNoise motion = motionOf(order);
    const std::size_t rows = 9001;
    std::vector<StreamBlock> samples =
        movedBy(motion).samples(evenlySpaced(rows, 0.01), static_cast<unsigned>(order));
    std::vector<StreamBlock> reversed;
    for (std::size_t i = rows; i-- > 0;)
      reversed.push_back({-samples[i].time, samples[i].position, -samples[i].velocity});
    StreamModel model;
    model.density = motion.density;
    model.position_variance = 1e-6;
    model.velocity_variance = std::pow(motion.velocity_noise, 2);
    const auto forward = smoothed(samples, model, order, 0.01, 0.25, kInfinity);
    const auto backward = smoothed(reversed, model, order, 0.01, 0.25, kInfinity);
    // After 100 rows, 30 time constants, the start is forgotten.
    for (std::size_t row = 100; row + 100 < rows; ++row) {
      const SmoothedSample& one = forward[row];
      const SmoothedSample& other = backward[rows - 1 - row];
      for (int i = 0; i < 3; ++i) {
        const double deviation = std::sqrt(one.covariance(i, i));
        ASSERT_NEAR(one.motion[i], (i == 1 ? -1 : 1) * other.motion[i],
                    1e-3 * deviation + 4e-16 * std::abs(one.motion[i]))
            << row;
        ASSERT_NEAR(one.covariance(i, i), other.covariance(i, i), 1e-3 * one.covariance(i, i))
            << row;
      }
    }
  }
}

// At one speed, stamps that err by dt are positions that err by speed times dt.
TEST(StreamSmoother, NoiseOfStampsIsNoiseOfPositionsTimesTheSpeed) {
  IntegratedNoise motion = motionOf(4);
  motion.velocity_noise = -1;
  motion.density = 1e-12;
  motion.first_velocity = 5;
  const std::vector<StreamBlock> samples = motion.samples(evenlySpaced(300, 0.01), 4);
  StreamModel stamps;
  stamps.position_variance = 1e-6;
  stamps.stamp_variance = 1e-6;  // 5 mrad at this speed, five times the noise of positions
  stamps.density = densityFor(0.1, 26e-6, 4, 0.01);
  StreamModel positions = stamps;
  positions.position_variance = 26e-6;
  positions.stamp_variance = 0;
  const auto one = smoothed(samples, stamps, 4, 0.01, 0.25, kInfinity);
  const auto other = smoothed(samples, positions, 4, 0.01, 0.25, kInfinity);
  for (std::size_t row = 100; row < 200; ++row)
    for (int i = 0; i < 3; ++i) {
      // Except for what the speed is misjudged by.
      EXPECT_NEAR(one[row].covariance(i, i) / other[row].covariance(i, i), 1, 0.02);
      EXPECT_NEAR(one[row].motion[i], other[row].motion[i],
                  0.1 * std::sqrt(other[row].covariance(i, i)));
    }
}

TEST(StreamSmoother, KeepsTheDigitsOfFarPositions) {
  const IntegratedNoise motion = motionOf(4);
  std::vector<StreamBlock> near = motion.samples(evenlySpaced(200, 0.01), 5);
  // Positions that a double holds after a million turns as well.
  for (StreamBlock& block : near) block.position = std::round(block.position * 0x1p20) * 0x1p-20;
  std::vector<StreamBlock> far = near;
  constexpr double kFar = 0x1p23;
  for (StreamBlock& block : far) block.position += kFar;
  StreamModel model;
  model.density = motion.density;
  model.position_variance = 1e-6;
  const auto one = smoothed(near, model, 4, 0.01, 0.25, kInfinity);
  const auto other = smoothed(far, model, 4, 0.01, 0.25, kInfinity);
  for (std::size_t row = 0; row < near.size(); ++row) {
    EXPECT_EQ(one[row].motion[1], other[row].motion[1]);
    EXPECT_EQ(one[row].motion[2], other[row].motion[2]);
    EXPECT_NEAR(one[row].motion[0] + kFar, other[row].motion[0], 1e-8);
  }
}

TEST(StreamSmoother, AStretchOfOneRowStandsStill) {
  const std::vector<StreamBlock> samples{
      {0, 1, std::nan("")}, {1, 2, std::nan("")}, {2, 4, std::nan("")}};
  StreamModel model;
  for (const double lag : {0.0, kInfinity}) {
    const auto results = smoothed(samples, model, 4, 0.01, 0.25, lag);
    for (std::size_t row = 0; row < 3; ++row) {
      EXPECT_EQ(results[row].motion, Eigen::Vector3d(samples[row].position, 0, 0));
      EXPECT_EQ(results[row].covariance(0, 0), 1);
      EXPECT_GT(results[row].covariance(2, 2), 1e3);
    }
  }
  EXPECT_TRUE(smoothed({}, model, 4, 0.01, 0.25, kInfinity).empty());
}

}  // namespace
}  // namespace virtual_work_dynamics
