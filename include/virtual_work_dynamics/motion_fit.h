#pragma once

#include <Eigen/Core>
#include <memory>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"

namespace virtual_work_dynamics {

class LoopFit;

/// Takes the noise out of a measured motion of all joints as far as closed loops, wheels, blades
/// and couplings tell it: noisy coordinates violate them, and the motion that meets them with the
/// least moves, each counted in its standard deviation, is the most likely one. What is measured
/// well, as a wheel's turn, so corrects what is not, as where odometry has the base. Serves one
/// thread. Does not allocate after construction.
class MotionFit {
 public:
  /// Deviations beyond which noise does not explain by how much a motion violates the conditions:
  /// wheels slip, or dimensions are wrong. Deviations that are found while a motion changes may be
  /// too small by a factor of a few.
  static constexpr double kMost = 20;

  MotionFit(const Mechanism& mechanism, const Dynamics& dynamics);
  ~MotionFit();
  MotionFit(MotionFit&&) noexcept;
  MotionFit& operator=(MotionFit&&) noexcept;

  /// Whether there is something to fit motions to. There is not in open chains, nor, at present,
  /// where a joint turns freely or something is driven.
  bool any() const { return loops_ != nullptr; }

  /// Fits positions, velocities and accelerations, in this order. Does nothing without any().
  /// Coordinates whose variance is zero are exact and stay.
  /// @param motion of all coordinates
  /// @param covariance of its coordinates; the variances count
  /// @param rates whether velocities and accelerations are fitted, too
  /// @returns whether noise explains what the motion violated. Where it does not, the level at
  ///   fault and those after it stay as they are; see farthest().
  /// @throws MotionError when the motion or the covariance has another number of coordinates.
  bool fit(Motion& motion, const MotionCovariance& covariance, bool rates = true);

  /// What was, or would have been, moved the most by the latest fit().
  struct Farthest {
    double deviations = 0;
    int coordinate = -1;  ///< -1: nothing had to be moved
    int level = 0;        ///< 0, 1, 2: position, velocity, acceleration
  };
  const Farthest& farthest() const { return farthest_; }

 private:
  Eigen::Index coordinates_;
  std::unique_ptr<LoopFit> loops_;
  Farthest farthest_;
};

}  // namespace virtual_work_dynamics
