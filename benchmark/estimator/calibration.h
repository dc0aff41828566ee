#pragma once

#include "estimator/effort_judge.h"
#include "estimator/estimator_runs.h"
#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {

/// Shares of the errors that are within two of the standard deviations that came with them.
struct Calibration {
  double acceleration = 0;
  double effort = 0;
};

/// Of all joints and rows for which there is a motion.
Calibration calibrate(const Deviations& deviations, const InverseDynamics& dynamics,
                      const EffortJudge& judge, const EstimatedRows& estimated);

}  // namespace virtual_work_dynamics
