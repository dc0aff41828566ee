// Measured motions that are moved to where loops and wheels allow them, by as little as can be.
#include "virtual_work_dynamics/motion_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "fitted_motions.h"
#include "four_bar.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using fitted_motions::kNoNoise;
using fitted_motions::Moving;
using fitted_motions::unevenCovariance;
using fitted_motions::violationBy;
using fitted_motions::withNoise;

constexpr const char* kLoops[] = {"four_bar",       "slider_crank",          "planar_3rrr",
                                  "stewart_gough",  "spatial_parallelogram", "andrews_squeezer",
                                  "planetary_gear", "coupled_wrist"};

// The sum of moves, each over its variance, along a way, against the sums of magnitudes.
double slopeAlong(const Eigen::VectorXd& way, const Eigen::VectorXd& moves,
                  const MotionCovariance& covariance, int level) {
  double sum = 0, magnitudes = 0;
  for (std::size_t i = 0; i < covariance.coordinates.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double term = way[k] * moves[k] / covariance.coordinates[i](level, level);
    sum += term;
    magnitudes += std::abs(term);
  }
  return magnitudes == 0 ? 0 : std::abs(sum) / magnitudes;
}

TEST(MotionFit, NoisyLoopsCloseByTheLeastMoves) {
  for (const char* name : kLoops) {
    SCOPED_TRACE(name);
    const Moving example(name);
    MotionFit fit(example.mechanism, example.dynamics);
    ASSERT_TRUE(fit.any());
    const Eigen::Index n = example.motion.q.size();
    const MotionCovariance covariance = unevenCovariance(n, {1e-4, 1e-2, 0.3});
    std::mt19937 random(7);
    for (int draw = 0; draw < 20; ++draw) {
      const Motion measured = withNoise(example.motion, covariance, random);
      Motion fitted = measured;
      ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained)
          << fit.outcome().farthest.deviations;
      EXPECT_GT(violationBy(example.dynamics, measured), 1e-6);
      EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12);
      // Where the least move ends, none of the ways that are open leads closer.
      for (const Eigen::VectorXd& way : example.waysAt(fitted.q)) {
        EXPECT_LT(slopeAlong(way, fitted.q - measured.q, covariance, 0), 1e-5);
        EXPECT_LT(slopeAlong(way, fitted.qd - measured.qd, covariance, 1), 1e-9);
        EXPECT_LT(slopeAlong(way, fitted.qdd - measured.qdd, covariance, 2), 1e-9);
      }
    }
  }
}

TEST(MotionFit, MotionsThatCloseTheLoopsStay) {
  for (const char* name : kLoops) {
    const Moving example(name);
    MotionFit fit(example.mechanism, example.dynamics);
    Motion motion = example.motion;
    const MotionCovariance covariance = unevenCovariance(motion.q.size(), {1e-4, 1e-2, 0.3});
    ASSERT_TRUE(fit.fit(motion, &covariance, kNoNoise).explained) << name;
    EXPECT_LT((motion.q - example.motion.q).norm(), 1e-12) << name;
    EXPECT_LT((motion.qd - example.motion.qd).norm(), 1e-10) << name;
    EXPECT_LT((motion.qdd - example.motion.qdd).norm(), 1e-9) << name;
    EXPECT_LT(fit.outcome().farthest.deviations, 1e-6) << name;
  }
}

// The sum of squares that the fit takes away is as large as noise makes it: one for each condition
// that counts.
TEST(MotionFit, MovesAreAsLargeAsTheNoiseMakesThem) {
  const Moving example("planar_3rrr");
  MotionFit fit(example.mechanism, example.dynamics);
  const Eigen::Index n = example.motion.q.size();
  const MotionCovariance covariance = unevenCovariance(n, {1e-5, 1e-3, 0.03});
  std::mt19937 random(3);
  double squares[3] = {0, 0, 0}, rms = 0;
  constexpr int kDraws = 400;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Motion measured = withNoise(example.motion, covariance, random);
    Motion fitted = measured;
    ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained);
    rms += std::pow(fit.outcome().velocity_rms, 2);
    const Eigen::VectorXd moves[3] = {fitted.q - measured.q, fitted.qd - measured.qd,
                                      fitted.qdd - measured.qdd};
    for (int level = 0; level < 3; ++level) {
      for (Eigen::Index i = 0; i < n; ++i) {
        const double variance = covariance.coordinates[static_cast<std::size_t>(i)](level, level);
        squares[level] += moves[level][i] * moves[level][i] / variance;
      }
    }
  }
  const double conditions = static_cast<double>(n) - 3;  // three motors move it
  // Four standard deviations of the mean. Velocities contain those of positions, too, times how
  // the conditions turn, which is little at these deviations.
  const double most = 4 * std::sqrt(2 * conditions / kDraws);
  for (const double sum : squares) EXPECT_NEAR(sum / kDraws, conditions, most);
  EXPECT_NEAR(rms / kDraws, squares[1] / kDraws / conditions, 1e-9);
}

TEST(MotionFit, WheelsTellHowTheBaseMoves) {
  const LoopExample example("mobile_manipulator");
  const Dynamics dynamics(example.mechanism, example.scene);
  MotionFit fit(example.mechanism, dynamics);
  ASSERT_TRUE(fit.any());
  const auto place = [&](const char* name) { return example.mechanism.coordinateIndex(name); };
  // Half the track and the radius are those of the description.
  const double angle = 0.6, v = 0.7, w = -0.9, a = 0.4, turn = 1.3, r = 0.08, half = 0.2;
  Motion truth(dynamics.coordinates());
  truth.q[place("base_yaw")] = angle;
  truth.q[place("shoulder")] = 0.3;
  truth.qd[place("base_x")] = v * std::cos(angle);
  truth.qd[place("base_y")] = v * std::sin(angle);
  truth.qd[place("base_yaw")] = w;
  truth.qd[place("left_wheel")] = (v - half * w) / r;
  truth.qd[place("right_wheel")] = (v + half * w) / r;
  truth.qdd[place("base_x")] = a * std::cos(angle) - v * w * std::sin(angle);
  truth.qdd[place("base_y")] = a * std::sin(angle) + v * w * std::cos(angle);
  truth.qdd[place("base_yaw")] = turn;
  truth.qdd[place("left_wheel")] = (a - half * turn) / r;
  truth.qdd[place("right_wheel")] = (a + half * turn) / r;
  truth.qdd[place("shoulder")] = 2;
  ASSERT_LT(violationBy(dynamics, truth), 1e-14);

  MotionCovariance covariance;
  covariance.coordinates.assign(8, Eigen::Vector3d(1e-8, 1e-6, 1e-4).asDiagonal());
  for (const char* name : {"base_x", "base_y", "base_yaw"}) {
    covariance.coordinates[static_cast<std::size_t>(place(name))] =
        Eigen::Vector3d(1e-14, 0.01, 1).asDiagonal();
  }
  std::mt19937 random(11);
  double before = 0, after = 0;
  for (int draw = 0; draw < 100; ++draw) {
    const Motion measured = withNoise(truth, covariance, random);
    Motion fitted = measured;
    ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained);
    EXPECT_LT(violationBy(dynamics, fitted), 1e-13);
    // Nothing says where the base is, or how the arm moves, but measurements.
    EXPECT_EQ(fitted.q, measured.q);
    EXPECT_EQ(fitted.qdd[place("shoulder")], measured.qdd[place("shoulder")]);
    before += std::pow(measured.qdd[place("base_yaw")] - truth.qdd[place("base_yaw")], 2);
    after += std::pow(fitted.qdd[place("base_yaw")] - truth.qdd[place("base_yaw")], 2);
  }
  // Deviations of 1 rad/s^2, and of the difference of two wheels' 0.01 rad/s^2 over the track.
  EXPECT_NEAR(std::sqrt(before / 100), 1, 0.3);
  EXPECT_LT(std::sqrt(after / 100), 1.5 * 0.01 * std::sqrt(2.0) * r / (2 * half));
}

// The conditions out of an oblique plane have roundings for entries.
TEST(MotionFit, RoundingsAreNoConditions) {
  const FourBar four_bar;
  std::mt19937 random(5);
  for (const char pivot : {'A', 'B', 'C', 'D'}) {
    const FourBar::Cut cut = four_bar.cut(pivot);
    const Dynamics dynamics(cut.mechanism, cut.scene);
    MotionFit fit(cut.mechanism, dynamics);
    const MotionCovariance covariance =
        unevenCovariance(dynamics.coordinates(), {1e-5, 1e-3, 0.03});
    for (int i = 0; i < 20; ++i) {
      const Motion exact = cut.motion(four_bar.turnings(0.3L * i, 1, 2));
      Motion fitted = withNoise(exact, covariance, random);
      EXPECT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained) << pivot << i;
      EXPECT_LT(violationBy(dynamics, fitted), 1e-12) << pivot << i;
      EXPECT_LT((fitted.q - exact.q).norm(), 1e-3) << pivot << i;
      EXPECT_LT((fitted.qd - exact.qd).norm(), 0.1) << pivot << i;
    }
  }
}

TEST(MotionFit, ExactCoordinatesStay) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  MotionCovariance covariance = unevenCovariance(example.motion.q.size(), {1e-4, 1e-2, 0.3});
  std::mt19937 random(2);
  const Motion measured = withNoise(example.motion, covariance, random);
  covariance.coordinates[0].setZero();
  Motion fitted = measured;
  ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained);
  EXPECT_EQ(fitted.q[0], measured.q[0]);
  EXPECT_EQ(fitted.qd[0], measured.qd[0]);
  EXPECT_EQ(fitted.qdd[0], measured.qdd[0]);
  EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12);
}

TEST(MotionFit, RatesStayWhereTheyAreNotAskedFor) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  const MotionCovariance covariance = unevenCovariance(example.motion.q.size(), {1e-4, 1e-2, 0.3});
  std::mt19937 random(2);
  const Motion measured = withNoise(example.motion, covariance, random);
  Motion fitted = measured;
  ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise, false).closed);
  EXPECT_NE(fitted.q, measured.q);
  EXPECT_EQ(fitted.qd, measured.qd);
  EXPECT_EQ(fitted.qdd, measured.qdd);
}

// Shafts that turn together by as many couplings.
TEST(MotionFit, GroupsOfManyConditionsStay) {
  for (const int couplings : {60, 110}) {
    RobotBuilder builder(1);
    Scene scene;
    for (int i = 0; i <= couplings; ++i) {
      builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), Matrix3l::Identity(),
                  Vector3l::Zero());
      if (i == 0) continue;
      Coupling coupling;
      coupling.name = "coupling_" + std::to_string(i);
      coupling.terms = {{"joint_" + std::to_string(i), 1.0},
                        {"joint_" + std::to_string(i + 1), -1.0}};
      scene.couplings.push_back(coupling);
    }
    scene.actuated = {"joint_1"};
    const Mechanism mechanism = builder.build();
    const Dynamics dynamics(mechanism, scene);
    MotionFit fit(mechanism, dynamics);
    std::mt19937 random(1);
    const MotionCovariance covariance =
        unevenCovariance(dynamics.coordinates(), {1e-5, 1e-3, 1e-2});
    const Motion measured = withNoise(Motion(dynamics.coordinates()), covariance, random);
    Motion fitted = measured;
    EXPECT_TRUE(fit.fit(fitted, &covariance, kNoNoise).closed);
    EXPECT_EQ(violationBy(dynamics, fitted) < 1e-12, couplings < 100);
    EXPECT_EQ(fitted.q == measured.q, couplings > 100);
  }
}

TEST(MotionFit, OpenChainsAreNotFitted) {
  const LoopExample example("six_axis_arm");
  const Dynamics dynamics(example.mechanism, example.scene);
  MotionFit fit(example.mechanism, dynamics);
  EXPECT_FALSE(fit.any());
  Motion motion(dynamics.coordinates());
  EXPECT_TRUE(fit.fit(motion, nullptr, kNoNoise).explained);
  EXPECT_EQ(fit.outcome().farthest.coordinate, -1);
}

TEST(MotionFit, RefusesAnotherNumberOfCoordinates) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  Motion motion = example.motion;
  const MotionCovariance covariance = unevenCovariance(2, {1, 1, 1});
  EXPECT_THROW(fit.fit(motion, &covariance, kNoNoise), MotionError);
  EXPECT_THROW(fit.fit(motion, nullptr, Eigen::VectorXd::Zero(2)), MotionError);
  Motion short_motion(2);
  EXPECT_THROW(fit.fit(short_motion, &covariance, kNoNoise), MotionError);
}

}  // namespace
}  // namespace virtual_work_dynamics
