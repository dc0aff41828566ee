#pragma once

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "compound_cases.h"
#include "dynamics/root_by_link.h"
#include "moving_roots.h"
#include "random_motions.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {

/// Deviations by what is uncertain besides coordinates, against spreads of drawn motions and loads.
namespace deviation_sources {

constexpr int kDraws = 4000;
// Five of the standard deviations that an estimate of a standard deviation from that many draws
// has, 1 / sqrt(2 kDraws).
constexpr double kStatistical = 5 / 89.4;

inline Request everything(const Mechanism& mechanism, const Scene& scene) {
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  return request;
}

// A covariance with correlations between all numbers, of these standard deviations.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> randomMatrix(std::mt19937& generator,
                                                 const Eigen::Matrix<double, kSize, 1>& sizes) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, kSize, kSize> factor;
  for (int i = 0; i < factor.size(); ++i) factor.data()[i] = normal(generator);
  Eigen::Matrix<double, kSize, kSize> C = factor * factor.transpose();
  const Eigen::Matrix<double, kSize, 1> scale =
      sizes.cwiseQuotient(C.diagonal().cwiseSqrt()).eval();
  return scale.asDiagonal() * C * scale.asDiagonal();
}

template <int kSize>
Eigen::Matrix<double, kSize, 1> draw(std::mt19937& generator,
                                     const Eigen::Matrix<double, kSize, kSize>& C) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, kSize, 1> numbers;
  for (int i = 0; i < kSize; ++i) numbers[i] = normal(generator);
  return C.llt().matrixL() * numbers;
}

inline Eigen::Quaterniond turnedBy(const Eigen::Quaterniond& orientation,
                                   const Eigen::Vector3d& turn) {
  return orientation * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()));
}

// All sources together, so that also their places are tested; each may be switched off.
struct Sources {
  explicit Sources(unsigned seed) : generator(seed) {}

  void ofRoot() {
    Eigen::Matrix<double, 12, 1> sizes;
    sizes << Eigen::Vector3d(1e-4, 2e-4, 3e-4), Eigen::Vector3d(1e-3, 2e-3, 1e-3),
        Eigen::Vector3d(2e-2, 1e-2, 3e-2), Eigen::Vector3d(1e-2, 3e-2, 2e-2);
    covariance.root = randomMatrix(generator, sizes);
    root = true;
  }
  void ofTurns(std::size_t count) {
    Eigen::Matrix<double, 9, 1> sizes;
    sizes << Eigen::Vector3d(2e-4, 1e-4, 2e-4), Eigen::Vector3d(2e-3, 1e-3, 3e-3),
        Eigen::Vector3d(2e-2, 3e-2, 1e-2);
    for (std::size_t i = 0; i < count; ++i)
      covariance.turns.push_back(randomMatrix(generator, sizes));
  }
  void ofWrenches(std::size_t count) {
    Eigen::Matrix<double, 6, 1> sizes;
    sizes << 0.3, 0.2, 0.4, 0.05, 0.1, 0.02;
    for (std::size_t i = 0; i < count; ++i)
      covariance.wrenches.push_back(randomMatrix(generator, sizes));
  }
  void ofCoordinates(Eigen::Index count, double size) {
    covariance.coordinates = randomCovariance(3, count, 1e-4).coordinates;
    for (Eigen::Matrix3d& C : covariance.coordinates) C *= size * size;
  }

  Motion motion(const Mechanism& mechanism, const Motion& mean) {
    Motion drawn = mean;
    if (drawn.orientations.empty()) drawn.orientations.resize(mechanism.orientations());
    for (std::size_t i = 0; i < covariance.coordinates.size(); ++i) {
      if (covariance.coordinates[i].isZero(0)) continue;
      const Eigen::Vector3d noise = draw<3>(generator, covariance.coordinates[i]);
      const auto place = static_cast<Eigen::Index>(i);
      drawn.q[place] += noise[0];
      drawn.qd[place] += noise[1];
      drawn.qdd[place] += noise[2];
    }
    for (std::size_t i = 0; i < covariance.turns.size(); ++i) {
      const Eigen::Matrix<double, 9, 1> noise = draw<9>(generator, covariance.turns[i]);
      FreeTurn turn = freeTurnOf(mechanism, i, mean);
      turn.orientation = turnedBy(turn.orientation, noise.head<3>());
      turn.angular_velocity += noise.segment<3>(3);
      turn.angular_acceleration += noise.tail<3>();
      setFreeTurn(mechanism, i, turn, drawn);
    }
    if (!root || covariance.root_link != 0) return drawn;
    const Eigen::Matrix<double, 12, 1> noise = draw<12>(generator, covariance.root);
    drawn.root.orientation = turnedBy(drawn.root.orientation, noise.head<3>());
    drawn.root.angular_velocity += noise.segment<3>(3);
    drawn.root.angular_acceleration += noise.segment<3>(6);
    drawn.root.acceleration += noise.tail<3>();
    return drawn;
  }
  // Where a sensor on another link tells how the root moves: the root's motion for the drawn
  // motions of this link and of all joints.
  void placeRoot(const Mechanism& mechanism, const Motion& mean, Motion& drawn) {
    if (covariance.root_link == 0) return;
    RootByLink by_link(mechanism);
    by_link.place(mean, covariance.root_link);
    RootMotion link = by_link.linkOf(mean.root);
    const Eigen::Matrix<double, 12, 1> noise = draw<12>(generator, covariance.root);
    link.orientation = turnedBy(link.orientation, noise.head<3>());
    link.angular_velocity += noise.segment<3>(3);
    link.angular_acceleration += noise.segment<3>(6);
    link.acceleration += noise.tail<3>();
    by_link.place(drawn, covariance.root_link);
    drawn.root = by_link.rootOf(link);
  }
  Load load(const Scene& scene) {
    Load drawn(scene);
    for (std::size_t i = 0; i < covariance.wrenches.size(); ++i) {
      if (!scene.applied_wrenches[i].deviation) continue;
      const Eigen::Matrix<double, 6, 1> noise = draw<6>(generator, covariance.wrenches[i]);
      drawn.wrenches[i].force += noise.head<3>();
      drawn.wrenches[i].torque += noise.tail<3>();
    }
    return drawn;
  }

  std::mt19937 generator;
  MotionCovariance covariance;
  bool root = false;
};

// Deviations, of which some may be unknown, against the spread of kDraws results.
inline void expectSpread(const std::vector<double>& found, const Spread& spread) {
  double largest = 0;
  for (const double value : found) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  ASSERT_GT(largest, 0);
  std::size_t known = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::isnan(found[i])) continue;
    ++known;
    // Components that the motion does not reach have rounding errors only.
    EXPECT_NEAR(found[i], spread.deviation(i), kStatistical * found[i] + 1e-6 * largest) << i;
  }
  EXPECT_GE(known, found.size() / 4);
}

// Every deviation against the spread of results of drawn motions and loads.
inline void expectDrawn(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                        Sources& sources) {
  const Request request = everything(mechanism, scene);
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace computed = deviations.makeWorkspace();
  deviations.computeMotion(motion, sources.covariance, computed);
  const Dynamics dynamics(mechanism, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Spread spread;
  for (int i = 0; i < kDraws; ++i) {
    Motion drawn = sources.motion(mechanism, motion);
    ASSERT_TRUE(dynamics.complete(drawn, workspace));
    sources.placeRoot(mechanism, motion, drawn);
    dynamics.compute(drawn, sources.load(scene), workspace);
    spread.add(numbersOf(workspace.results()));
  }
  expectSpread(numbersOf(computed.motion()), spread);
}

inline Scene sceneWithWrenches(std::vector<std::string> links) {
  Scene scene;
  for (const std::string& link : links) {
    AppliedWrench wrench;
    wrench.link = link;
    wrench.at << 0.1, -0.2, 0.3;
    wrench.force << 3, -2, 5;
    scene.applied_wrenches.push_back(wrench);
  }
  return scene;
}

}  // namespace deviation_sources
}  // namespace virtual_work_dynamics
