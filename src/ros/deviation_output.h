#pragma once

#include <memory>
#include <string>

#include "ros/deviation_record.h"
#include "ros/outputs.h"

namespace virtual_work_dynamics {

/// Makes ~effort_deviation: standard deviations of efforts by the covariance of the motion. Samples
/// whose covariance is not known, as those of trajectories, are not published.
/// @param record of the deviations, those by the scene's tolerances included
std::unique_ptr<Output> makeDeviationOutput(const Mechanism& mechanism, const std::string& frame,
                                            std::shared_ptr<DeviationRecord> record);

/// Makes ~effort_tolerance: standard deviations of efforts by the scene's tolerances.
std::unique_ptr<Output> makeToleranceOutput(const Mechanism& mechanism, const std::string& frame);

}  // namespace virtual_work_dynamics
