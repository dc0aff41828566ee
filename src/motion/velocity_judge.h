#pragma once

#include <vector>

#include "motion/stream_identification.h"

namespace virtual_work_dynamics {

/// How velocities compare with the positions that come with them.
struct VelocityJudgement {
  bool moved = false;  ///< whether the joint moved enough to tell
  bool agree = true;   ///< whether they may be used
  double ratio = 1;    ///< velocities over slopes of the positions, by least squares
};

/// Compares integrals of the velocities with the differences of the positions over a tenth of a
/// second. Noise that averages out is no contradiction; another unit, another sign, zeros and
/// velocities that are not those of the motion are.
/// @param interval s, usual time from block to block.   @param noise of a position, rad or m.
VelocityJudgement judgeVelocities(const std::vector<StreamBlock>& blocks, double interval,
                                  double noise);

}  // namespace virtual_work_dynamics
