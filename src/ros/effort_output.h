#pragma once

#include <memory>
#include <string>

#include "ros/outputs.h"
#include "ros/threshold_record.h"

namespace virtual_work_dynamics {

/// Makes ~effort: names, the positions and velocities used, and efforts.
/// @param limits record of efforts beyond the limits of the description, for which it is always
///   computed; null: none
std::unique_ptr<Output> makeEffortOutput(const std::string& frame,
                                         std::shared_ptr<ThresholdRecord> limits);

}  // namespace virtual_work_dynamics
