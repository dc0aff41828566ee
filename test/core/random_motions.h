#pragma once

#include <Eigen/Cholesky>
#include <cstddef>
#include <random>
#include <vector>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Draws motions about a motion, by a covariance that is positive definite.
class RandomMotions {
 public:
  RandomMotions(unsigned seed, const Motion& mean, const MotionCovariance& covariance)
      : generator_(seed), mean_(mean) {
    for (const Eigen::Matrix3d& C : covariance.coordinates) factors_.push_back(C.llt().matrixL());
  }

  Motion draw() {
    Motion motion = mean_;
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      const double a = normal_(generator_), b = normal_(generator_), c = normal_(generator_);
      const Eigen::Vector3d noise = factors_[i] * Eigen::Vector3d(a, b, c);
      const auto place = static_cast<Eigen::Index>(i);
      motion.q[place] += noise[0];
      motion.qd[place] += noise[1];
      motion.qdd[place] += noise[2];
    }
    return motion;
  }

 private:
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
  const Motion mean_;
  std::vector<Eigen::Matrix3d> factors_;
};

/// A covariance with correlations in which each level of each coordinate has its own size.
inline MotionCovariance randomCovariance(unsigned seed, Eigen::Index coordinates, double size) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.3, 1);
  MotionCovariance covariance;
  for (Eigen::Index i = 0; i < coordinates; ++i) {
    const double q = uniform(generator) * size, qd = 10 * uniform(generator) * size,
                 qdd = 100 * uniform(generator) * size;
    Eigen::Matrix3d C;
    C << q * q, 0.5 * q * qd, -0.6 * q * qdd,   //
        0.5 * q * qd, qd * qd, 0.1 * qd * qdd,  //
        -0.6 * q * qdd, 0.1 * qd * qdd, qdd * qdd;
    covariance.coordinates.push_back(C);
  }
  return covariance;
}

/// All efforts and components of reactions one after the other.
template <typename AnyResults>
std::vector<double> numbersOf(const AnyResults& results) {
  std::vector<double> numbers(results.effort.data(), results.effort.data() + results.effort.size());
  for (const auto* wrenches : {&results.child_axes, &results.root_axes}) {
    for (const Wrench& wrench : *wrenches) {
      numbers.insert(numbers.end(), wrench.force.data(), wrench.force.data() + 3);
      numbers.insert(numbers.end(), wrench.torque.data(), wrench.torque.data() + 3);
    }
  }
  return numbers;
}

/// The standard deviations of numbers that are added, about the mean that they have.
class Spread {
 public:
  void add(const std::vector<double>& numbers) {
    sums_.resize(numbers.size());
    squares_.resize(numbers.size());
    if (count_ == 0) first_ = numbers;  // against cancellation
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double x = numbers[i] - first_[i];
      sums_[i] += x;
      squares_[i] += x * x;
    }
    ++count_;
  }
  double deviation(std::size_t i) const {
    const double n = static_cast<double>(count_);
    return std::sqrt(std::max(0.0, (squares_[i] - sums_[i] * sums_[i] / n) / (n - 1)));
  }

 private:
  std::vector<double> first_, sums_, squares_;
  std::size_t count_ = 0;
};

}  // namespace virtual_work_dynamics
