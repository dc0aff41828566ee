#pragma once

namespace virtual_work_dynamics {

/// What is known beforehand of the samples that a motion is estimated from. Negative values are
/// found from the samples themselves, joint by joint; others hold for every joint.
struct NoiseSettings {
  double position_noise = -1;  ///< standard deviation of a position, rad or m
  double velocity_noise = -1;  ///< standard deviation of a velocity, rad/s or m/s
  double stamp_noise = -1;     ///< standard deviation of a stamp, s
  double bandwidth = -1;       ///< Hz: what swings so fast keeps half of its amplitude
  bool use_velocity = true;    ///< whether velocities are used where they are given
};

/// What the samples of a joint were found to be.
struct StreamQuality {
  double interval = 0;        ///< usual time from sample to sample, s
  double position_noise = 0;  ///< standard deviation of a position, rad or m
  double velocity_noise = 0;  ///< rad/s or m/s; negative: velocities are not given or not used
  double stamp_noise = 0;     ///< s
  double bandwidth = 0;       ///< Hz
  /// Velocities over slopes of the positions where they contradict each other, so that they are
  /// not used: 0 for velocities that are always zero, 57.3 for degrees. 1: no contradiction.
  double velocity_ratio = 1;
  int jumps = 0;     ///< steps that no motion makes: behind each another motion begins
  int left_out = 0;  ///< positions that stand alone, far from those before and after
};

}  // namespace virtual_work_dynamics
