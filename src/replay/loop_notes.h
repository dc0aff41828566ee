#pragma once

#include <string>
#include <vector>

#include "ros/loop_limits.h"
#include "ros/loop_record.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// What was found about closed loops and contacts in all samples, a line each: forces that cannot
/// act so, loops that are violated, singular positions and what is left out there.
/// @param reactions that the report counts   @param where to stand before each
std::string loopNotes(const LoopRecord::Report& report, const Dynamics& dynamics,
                      const Mechanism& mechanism, const std::vector<std::string>& reactions,
                      const LoopLimits& limits, const std::string& where);

}  // namespace virtual_work_dynamics
