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
  /// Deviations of a position or velocity beyond which noise does not explain a move. Deviations
  /// that are found while a motion changes may be too small by a factor of a few.
  static constexpr double kMost = 20;
  /// Positions that leave the conditions open by more, rad or over the length of the loops, stay.
  static constexpr double kNearlyClosed = 0.01;

  /// @param tolerance moves up to it need no explanation: rad or over the length of the loops, of
  ///   velocities relative to the largest; positions that are so far from closed are moved, too
  MotionFit(const Mechanism& mechanism, const Dynamics& dynamics, double tolerance = 0);
  ~MotionFit();
  MotionFit(MotionFit&&) noexcept;
  MotionFit& operator=(MotionFit&&) noexcept;

  /// Whether there is anything to fit motions to. There is not in open chains, nor, at present,
  /// where a joint turns freely or something is driven. Loops of more than 100 conditions that
  /// share coordinates stay as they are measured.
  bool any() const { return loops_ != nullptr; }

  /// What a fit did.
  struct Farthest {
    double deviations = 0;  ///< by which it was moved; 0: nothing was
    int coordinate = -1;    ///< -1: nothing was moved
    int level = 0;          ///< 0, 1: position, velocity
    double amount = 0;      ///< of the move, rad or m, per s
  };
  struct Outcome {
    bool closed = true;     ///< false: positions are too far from closed, and stayed
    bool explained = true;  ///< whether noise explains all moves of positions and velocities
    /// Roots of the mean squares of these moves, in deviations, for each condition that counts;
    /// noise makes that of velocities 1, and that of positions less, as these are smoothed and
    /// single ones count. 0: deviations are not known.
    double position_rms = 0, velocity_rms = 0;
    bool wheels = false;  ///< whether there are conditions on rates alone, such as those of wheels
    Farthest farthest;
  };

  /// Fits positions, velocities and accelerations, in this order; does nothing without any().
  /// Coordinates whose variance is zero are exact and stay.
  /// @param motion of all coordinates
  /// @param covariance of its coordinates, of which the variances count; null: not known, all
  ///   coordinates move alike
  /// @param noise standard deviations of single positions, rad or m, which positions are never
  ///   better than: what an encoder at rest rounds away does not average out; empty: zero
  /// @param rates whether velocities and accelerations are fitted, too
  /// @throws MotionError when something has another number of coordinates.
  const Outcome& fit(Motion& motion, const MotionCovariance* covariance,
                     const Eigen::VectorXd& noise, bool rates = true);
  const Outcome& outcome() const { return outcome_; }

 private:
  Eigen::Index coordinates_;
  double tolerance_;
  std::unique_ptr<LoopFit> loops_;
  Outcome outcome_;
};

}  // namespace virtual_work_dynamics
