#pragma once

#include <memory>
#include <string>

#include "ros/effort_measurements.h"
#include "ros/outputs.h"
#include "ros/threshold_record.h"

namespace virtual_work_dynamics {

/// Makes ~residual: computed less measured efforts, the external effort of each joint, at the
/// instants of the results.
/// @param record of the values beyond thresholds, for which it is always computed; null: none
std::unique_ptr<Output> makeResidualOutput(const std::string& frame,
                                           std::shared_ptr<EffortMeasurements> efforts,
                                           std::shared_ptr<ThresholdRecord> record);

/// Makes ~external_effort: external efforts by a momentum observer, at the stamps of joint states,
/// as these have positions, velocities and efforts.
/// @param gain 1/s   @param record see makeResidualOutput()
std::unique_ptr<Output> makeExternalEffortOutput(const Mechanism& mechanism,
                                                 const std::string& frame, double gain,
                                                 double max_gap,
                                                 std::shared_ptr<EffortMeasurements> efforts,
                                                 std::shared_ptr<ThresholdRecord> record);

}  // namespace virtual_work_dynamics
