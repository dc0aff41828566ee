#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "loop_examples.h"
#include "virtual_work_dynamics/motion_fit.h"

namespace virtual_work_dynamics {
/// Motions with noise, and what is known of that, for fits.
namespace fitted_motions {

const Eigen::VectorXd kNoNoise;

// Deviations of position, velocity and acceleration, different for each coordinate.
inline MotionCovariance unevenCovariance(Eigen::Index coordinates,
                                         const Eigen::Vector3d& deviations) {
  MotionCovariance covariance;
  for (Eigen::Index i = 0; i < coordinates; ++i) {
    const double factor = std::pow(3.0, static_cast<double>((5 * i) % 4) - 2);
    const Eigen::Vector3d own = factor * deviations;
    covariance.coordinates.emplace_back(own.cwiseAbs2().asDiagonal());
  }
  return covariance;
}

inline Motion withNoise(Motion motion, const MotionCovariance& covariance, std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < covariance.coordinates.size(); ++i) {
    const Eigen::Vector3d own = covariance.coordinates[i].diagonal().cwiseSqrt();
    const auto k = static_cast<Eigen::Index>(i);
    motion.q[k] += own[0] * normal(random);
    motion.qd[k] += own[1] * normal(random);
    motion.qdd[k] += own[2] * normal(random);
  }
  return motion;
}

inline double violationBy(const Dynamics& dynamics, const Motion& motion) {
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  double most = 0;
  for (const ClosureResidual& residual : workspace.results().loops.relative_residuals) {
    most = std::max({most, residual.position, residual.velocity, residual.acceleration});
  }
  return most;
}

// An example, away from its assembly, in a motion that closes its loops.
struct Moving : LoopExample {
  explicit Moving(const std::string& name)
      : LoopExample(name), dynamics(mechanism, scene), motion(dynamics.coordinates()) {
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    motion.q = dynamics.assembly();
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      const auto k = static_cast<double>(i);
      motion.q[i] += 0.02 * std::sin(2 + k);
      motion.qd[i] = std::sin(1 + 2 * k);
      motion.qdd[i] = 3 * std::sin(3 + k);
    }
    EXPECT_TRUE(dynamics.complete(motion, workspace)) << name;
  }
  // The ways that the loops leave open, found by completing motions beside this one.
  std::vector<Eigen::VectorXd> waysAt(const Eigen::VectorXd& q) const {
    std::vector<Eigen::VectorXd> ways;
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    for (std::size_t i = 0; i < dynamics.actuated().size(); ++i) {
      if (!dynamics.actuated()[i]) continue;
      Motion at(q.size());
      at.q = q;
      at.qd[static_cast<Eigen::Index>(i)] = 1;
      EXPECT_TRUE(dynamics.complete(at, workspace));
      ways.push_back(at.qd);
    }
    return ways;
  }

  Dynamics dynamics;
  Motion motion;
};

}  // namespace fitted_motions
}  // namespace virtual_work_dynamics
