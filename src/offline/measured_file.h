#pragma once

#include "offline/measured_efforts.h"
#include "offline/motion_source.h"

namespace virtual_work_dynamics {

/// Reads the efforts of joint states that were measured: from bags, from CSV that StateCsv reads,
/// or from CSV with the columns `time` and `effort.<joint>`. Other columns of a CSV count as
/// efforts, too, unless they are of a kind that motions and results have, if `bare`: names of
/// joints then, maybe given by a rule of renaming. A header that ends in a range of names, as
/// `tau1..7`, stands for all of them. Empty cells and values that are not finite are left out. What
/// cannot be used is said on standard error.
/// @param source its topic, if any, is that of the joint states with efforts
/// @throws FileError, one line, when there are none, and as reading a motion does.
MeasuredEfforts readMeasuredEfforts(const MotionSource& source, bool bare);

}  // namespace virtual_work_dynamics
