#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {
namespace estimator_test {

using Verdict = MotionEstimator::Verdict;

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kWallClock = 1700000000123456789;  // ns; here a double resolves 2.4e-7 s

inline Mechanism mechanismOf(const std::vector<JointType>& types) {
  std::vector<Link> links(types.size() + 1);
  std::vector<Joint> joints(types.size());
  int coordinates = 0;
  for (std::size_t k = 0; k < types.size(); ++k) {
    joints[k].name = "joint" + std::to_string(k);
    joints[k].type = types[k];
    joints[k].parent_link = static_cast<int>(k);
    joints[k].child_link = static_cast<int>(k) + 1;
    if (types[k] != JointType::kFixed) joints[k].coordinate = coordinates++;
    links[k + 1].parent_joint = static_cast<int>(k);
  }
  return Mechanism("test", links, joints);
}

constexpr JointType kR = JointType::kRevolute;
constexpr JointType kC = JointType::kContinuous;

/// Position, velocity and acceleration of a coordinate at a time after kWallClock.
struct State {
  long double q;
  long double qd;
  long double qdd;
};
using Law = std::function<State(long double)>;

/// An estimator with the motion it evaluates.
struct Stream {
  Stream(const std::vector<JointType>& types, const EstimatorSettings& settings)
      : estimator(mechanismOf(types), settings), motion(static_cast<Eigen::Index>(types.size())) {
    covariance.coordinates.resize(types.size());
  }

  /// Pushes positions (and velocities) of coordinates, `time` ns after kWallClock.
  Verdict push(std::int64_t time, std::vector<int> coordinates, std::vector<double> q,
               std::vector<double> qd = {}) {
    return estimator.push(kWallClock + time, coordinates.data(), q.data(),
                          qd.empty() ? nullptr : qd.data(), static_cast<int>(coordinates.size()));
  }
  Verdict push(std::int64_t time, int coordinate, const Law& law, bool velocity = false) {
    const State state = law(static_cast<long double>(time) * 1e-9L);
    if (!velocity) return push(time, {coordinate}, {static_cast<double>(state.q)});
    return push(time, {coordinate}, {static_cast<double>(state.q)},
                {static_cast<double>(state.qd)});
  }
  /// Evaluates the motion. @returns the instant, ns after kWallClock.
  std::int64_t evaluate() { return estimator.evaluate(motion, &covariance) - kWallClock; }
  /// Evaluates every motion that is due and forgets it. @returns how many there were.
  int drain() {
    int motions = 0;
    for (; estimator.ready(); ++motions) evaluate();
    return motions;
  }

  MotionEstimator estimator;
  Motion motion;
  MotionCovariance covariance;
};

inline EstimatorSettings settingsOf(double lag) {
  EstimatorSettings settings;
  settings.lag = lag;
  return settings;
}

}  // namespace estimator_test
}  // namespace virtual_work_dynamics
