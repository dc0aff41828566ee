#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "plain_results.h"
#include "reference_113.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

#ifndef VWD_HAS_REAL113

TEST(SineCosine, IsMeasuredIn113Bits) {
  GTEST_SKIP() << "this compiler has no number of 113 bits";
}

#else

// Joints of the star: whole packs of none of the builds.
constexpr int kJoints = 11;

// Discs of 1 kg on a root that falls sideways at 1 m/s^2: the force of joint i is (cos, -sin, 0) of
// its angle in the disc's axes, exactly as the kernel has them.
InverseDynamics star(InstructionSet set) {
  RobotBuilder builder(1);
  for (int i = 0; i < kJoints; ++i) {
    const int disc =
        builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), Matrix3l::Identity(), {0, 0, 0});
    builder.removeInertia(disc);
    builder.link(disc).mass = 1;
  }
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.gravity = {-1, 0, 0};
  scene.static_motion = true;
  Request request;
  request.efforts = false;
  request.child_axes = requestedReactions(mechanism, scene);
  return InverseDynamics(mechanism, scene, request, set);
}

std::vector<Motion> samplesOf(const std::vector<double>& angles) {
  std::vector<Motion> samples;
  for (std::size_t n = 0; n * kJoints < angles.size(); ++n) {
    samples.emplace_back(kJoints);
    for (int i = 0; i < kJoints; ++i) {
      samples.back().q[i] = angles[(n * kJoints + static_cast<std::size_t>(i)) % angles.size()];
    }
  }
  return samples;
}

struct Expected {
  Real113 angle, sine, cosine;
};

// Expected values for the samples' angles, by joint and sample; Real is the type they are rounded
// to.
template <typename Real>
std::vector<Expected> expectedOf(const std::vector<Motion>& samples) {
  std::vector<Expected> expected;
  for (const Motion& sample : samples) {
    for (int i = 0; i < kJoints; ++i) {
      const Real113 angle = static_cast<Real>(sample.q[i]);
      expected.push_back({angle, sine(angle), cosine(angle)});
    }
  }
  return expected;
}

// Half a unit of the last digit of 1 for the polynomial, and half a unit of the last digit of what
// is less than 1 for rounding.
template <typename Real>
constexpr double kTolerance = 0.75 * static_cast<double>(std::numeric_limits<Real>::epsilon());
// Relative to sines and cosines that are nearly zero: one unit more for the reduced angle. The
// three parts of pi/2 have the digits for that up to some number of turns.
template <typename Real>
constexpr double kRelative = 1.5 * static_cast<double>(std::numeric_limits<Real>::epsilon());
template <typename Real>
constexpr double kFewTurns = sizeof(Real) == sizeof(double) ? 1600 : 0.78;

template <typename Real>
void expectClose(const std::vector<Expected>& expected,
                 const std::vector<PlainResults<Real> >& results) {
  double absolute = 0, relative = 0;
  const auto take = [&](const Expected& angle, Real113 value, Real113 error) {
    ASSERT_TRUE(isFinite(error)) << static_cast<double>(angle.angle);
    absolute = std::max(absolute, static_cast<double>(error));
    if (magnitude(angle.angle) < kFewTurns<Real> &&
        magnitude(value) > std::numeric_limits<Real>::min()) {
      relative = std::max(relative, static_cast<double>(error / magnitude(value)));
    }
  };
  for (std::size_t n = 0; n < expected.size(); ++n) {
    const Real* const force = &results[n / kJoints].child_axes[6 * (n % kJoints)];
    take(expected[n], expected[n].sine, magnitude(expected[n].sine + force[1]));
    take(expected[n], expected[n].cosine, magnitude(expected[n].cosine - force[0]));
  }
  EXPECT_LE(absolute, kTolerance<Real>);
  EXPECT_LE(relative, kRelative<Real>);
}

void expectAccurate(const char* what, const std::vector<double>& angles) {
  SCOPED_TRACE(what);
  const std::vector<Motion> samples = samplesOf(angles);
  const std::vector<Expected> expected = expectedOf<double>(samples);
  const std::vector<Expected> expected_float = expectedOf<float>(samples);
  for (const InstructionSet set : supportedInstructionSets()) {
    SCOPED_TRACE(toString(set));
    const InverseDynamics dynamics = star(set);
    std::vector<PlainResults<double> > one_by_one;
    for (const Motion& sample : samples) one_by_one.push_back(singleResults(dynamics, sample));
    expectClose(expected, one_by_one);
    constexpr BlockLayout kLayout = BlockLayout::kStructureOfArrays;
    expectClose(expected, blockResults<double>(dynamics, samples, kLayout, 1, set));
    expectClose(expected_float, blockResults<float>(dynamics, samples, kLayout, 1, set));
  }
}

constexpr int kAngles = 20000;

std::vector<double> uniform(double largest) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> distribution(-largest, largest);
  std::vector<double> angles;
  for (int i = 0; i < kAngles; ++i) angles.push_back(distribution(generator));
  return angles;
}

TEST(SineCosine, OfCommonAngles) {
  expectAccurate("up to pi/4", uniform(M_PI / 4));
  expectAccurate("a few turns", uniform(20));
}

TEST(SineCosine, OfManyTurns) {
  expectAccurate("within float's own range", uniform(3000));
  expectAccurate("within double's own range", uniform(1e6));
  expectAccurate("on both sides of the range", uniform(2e6));
  expectAccurate("up to 1e9", uniform(1e9));
}

TEST(SineCosine, OfAnyMagnitude) {
  std::vector<double> angles;
  for (const double exponent : uniform(300)) {
    angles.push_back((angles.size() % 2 ? -1 : 1) * std::pow(10, exponent));
  }
  // Beyond float's largest number there is no angle.
  for (double& angle : angles) {
    if (std::abs(angle) > 3e38) angle = 1e-30 * std::fmod(angle, 1e30);
  }
  expectAccurate("1e-300 to 1e38", angles);
}

// The doubles nearest to multiples of pi/4, and their neighbours.
TEST(SineCosine, NearTheAxes) {
  std::vector<double> angles = {0, -0.0, std::numeric_limits<double>::denorm_min(), 1e-310};
  for (int i = 0; i < kAngles / 6; ++i) {
    const double k = i < 1000 ? i : 1000 + 763.0 * (i - 1000);  // to 2.5e6, which is 2e6 rad
    const double angle = (i % 2 ? -k : k) * (M_PI / 4);
    for (const double sign : {1, -1}) {
      angles.push_back(sign * angle);
      angles.push_back(sign * std::nextafter(angle, 1e10));
      angles.push_back(sign * std::nextafter(angle, -1e10));
    }
  }
  expectAccurate("multiples of pi/4", angles);
}

TEST(SineCosine, OfNoAngleIsNoNumber) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Motion> samples =
      samplesOf({inf, 1, -inf, 2, std::numeric_limits<double>::quiet_NaN(), 3, 1e9, 0.5});
  for (const InstructionSet set : supportedInstructionSets()) {
    const InverseDynamics dynamics = star(set);
    const auto block =
        blockResults<double>(dynamics, samples, BlockLayout::kStructureOfArrays, 1, set);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const PlainResults<double> single = singleResults(dynamics, samples[n]);
      for (int i = 0; i < kJoints; ++i) {
        const double angle = samples[n].q[i];
        for (const auto* results : {&single, &block[n]}) {
          EXPECT_EQ(std::isfinite(results->child_axes[6 * i]), std::isfinite(angle)) << angle;
          EXPECT_EQ(std::isfinite(results->child_axes[6 * i + 1]), std::isfinite(angle)) << angle;
        }
      }
    }
  }
}

#endif

}  // namespace
}  // namespace virtual_work_dynamics
