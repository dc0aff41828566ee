#pragma once

#include <string>

#include "virtual_work_dynamics/noise_settings.h"

namespace virtual_work_dynamics {

/// Text like "1 kHz, position noise 2.1e-05 rad, bandwidth 12 Hz". @param unit rad or m
/// @param noise whose deviation StreamQuality::position_noise is
std::string streamText(const StreamQuality& quality, const std::string& unit,
                       const std::string& noise = "position noise");

/// Why the velocities of a joint are not used, with what they may be instead.
/// @param ratio of velocities over slopes of positions
std::string velocityProblem(const std::string& joint, double ratio);

}  // namespace virtual_work_dynamics
