#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace virtual_work_dynamics {
namespace encoder_streams {

constexpr double kTwoPi = 6.283185307179586;

/// Position, velocity and acceleration, rad …
struct State {
  double q;
  double qd;
  double qdd;
};
using Law = std::function<State(double t)>;

/// Moves to and fro with pauses between them, of piecewise constant jerk: accelerations of up to
/// 6 rad/s^2 that set in within `rise` s (0: at once, a trapezoid of the velocity).
class Moves {
 public:
  Moves(unsigned seed, double duration, double rise) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> part(0, 1);
    knots_.push_back({0, {2 * part(generator) - 1, 0, 0}, 0});
    add(0.3 + 0.2 * part(generator), 0);
    while (knots_.back().time < duration) {
      const double sign = knots_.back().state.q > 0 ? -1 : 1;
      const double acceleration = sign * (2 + 4 * part(generator));
      const double even = (rise > 0 ? 0 : 0.1) + 0.2 * part(generator);
      const double cruise = 0.5 * part(generator);
      for (const int half : {1, -1}) {
        change(half * acceleration, rise);
        add(even, 0);
        change(-half * acceleration, rise);
        if (half > 0) add(cruise, 0);
      }
      knots_.back().state.qd = knots_.back().state.qdd = 0;  // but for roundings they are
      add(0.15 + 0.25 * part(generator), 0);
    }
  }

  State operator()(double t) const {
    const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, t,
                                        [](double time, const Knot& k) { return time < k.time; });
    return at(*(after - 1), t);
  }

 private:
  struct Knot {
    double time;
    State state;
    double jerk;  // from here to the next one
  };

  static State at(const Knot& from, double time) {
    const double t = time - from.time;
    const State& s = from.state;
    return {s.q + t * (s.qd + t * (s.qdd / 2 + t * from.jerk / 6)),
            s.qd + t * (s.qdd + t * from.jerk / 2), s.qdd + t * from.jerk};
  }
  void add(double duration, double jerk) {
    knots_.back().jerk = jerk;
    const double end = knots_.back().time + duration;
    knots_.push_back({end, at(knots_.back(), end), 0});
  }
  void change(double acceleration, double rise) {
    if (rise > 0) {
      add(rise, acceleration / rise);
    } else {
      knots_.back().state.qdd += acceleration;
    }
  }

  std::vector<Knot> knots_;
};

/// A sum of five sines of up to half a hertz, moving from the start.
inline Law fourierLaw(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> part(-0.4, 0.4);
  std::vector<std::pair<double, double>> waves;
  for (int k = 1; k <= 5; ++k) {
    const double amplitude = part(generator) / k;
    waves.emplace_back(amplitude, 10 * part(generator));
  }
  return [waves](double t) {
    State state{0, 0, 0};
    for (std::size_t k = 0; k < waves.size(); ++k) {
      const double w = kTwoPi * 0.1 * static_cast<double>(k + 1);
      const double phase = w * t + waves[k].second;
      state.q += waves[k].first * std::sin(phase);
      state.qd += waves[k].first * w * std::cos(phase);
      state.qdd -= waves[k].first * w * w * std::sin(phase);
    }
    return state;
  };
}

/// How an encoder and its driver sample a motion.
struct Encoder {
  double rate = 1000;          // Hz
  double quantum = 1e-4;       // rad; 0: not rounded
  double white = 0;            // standard deviation of white noise before rounding, rad
  double jitter = 0;           // standard deviation of stamps, s
  double uneven = 0;           // part of the interval by which instants truly differ from even ones
  double dropped = 0;          // part of the rows that are missing
  double velocity_noise = -1;  // rad/s; negative: no velocities
};

/// What an encoder gives for some joints, with the truth.
struct Samples {
  std::vector<double> stamps;                  // s, increasing
  std::vector<std::vector<double>> positions;  // of each joint
  std::vector<std::vector<double>> velocities;
  std::vector<std::vector<State>> truth;

  std::size_t rows() const { return stamps.size(); }
};

inline Samples sampled(const std::vector<Law>& laws, const Encoder& encoder, double duration,
                       unsigned seed) {
  // One generator for each kind of noise: what is left out of one does not change another.
  std::mt19937 drop(seed), instant(seed + 1), stamp(seed + 2), noise(seed + 3);
  std::uniform_real_distribution<double> part(0, 1);
  std::normal_distribution<double> normal(0, 1);
  Samples samples;
  samples.positions.resize(laws.size());
  samples.velocities.resize(laws.size());
  samples.truth.resize(laws.size());
  const int rows = static_cast<int>(duration * encoder.rate);
  for (int row = 0; row < rows; ++row) {
    if (part(drop) < encoder.dropped) continue;
    const double t = (row + encoder.uneven * (part(instant) - 0.5)) / encoder.rate;
    double stamped = t + encoder.jitter * normal(stamp);
    if (samples.rows() > 0) stamped = std::max(stamped, samples.stamps.back() + 1e-6);
    samples.stamps.push_back(stamped);
    for (std::size_t joint = 0; joint < laws.size(); ++joint) {
      const State state = laws[joint](t);
      double q = state.q + encoder.white * normal(noise);
      if (encoder.quantum > 0) q = std::round(q / encoder.quantum) * encoder.quantum;
      samples.positions[joint].push_back(q);
      samples.velocities[joint].push_back(state.qd +
                                          std::max(0.0, encoder.velocity_noise) * normal(noise));
      samples.truth[joint].push_back(state);
    }
  }
  if (encoder.velocity_noise < 0) samples.velocities.clear();
  return samples;
}

/// Weights of the least-squares polynomial of order 5 through `width` samples for the position,
/// velocity and acceleration in their middle (Savitzky and Golay 1964).
inline Eigen::MatrixXd savitzkyGolay(int width, double interval) {
  const int half = width / 2;
  Eigen::MatrixXd powers(width, 6);
  for (int i = 0; i < width; ++i)
    for (int k = 0; k < 6; ++k) powers(i, k) = std::pow(static_cast<double>(i - half) / half, k);
  const Eigen::MatrixXd inverse =
      powers.householderQr().solve(Eigen::MatrixXd::Identity(width, width));
  const double reach = half * interval;
  Eigen::MatrixXd weights = inverse.topRows(3);
  weights.row(1) /= reach;
  weights.row(2) *= 2 / (reach * reach);
  return weights;
}

}  // namespace encoder_streams
}  // namespace virtual_work_dynamics
