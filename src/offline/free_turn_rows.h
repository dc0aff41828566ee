#pragma once

#include "offline/motion_file.h"
#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Checks what a file gives of the joints that turn freely against what is needed, and warns of
/// what is not used. @throws FileError naming the columns that are missing.
/// @param given what the motion has to give
void checkFreeTurns(const Mechanism& mechanism, const Given& given, const MotionFile& file);

/// Completes the turns that a file gives, with notes on standard error, and puts them into its
/// table, which has columns of all coordinates. Rates count as zero in static scenes.
/// @throws FileError when rates cannot be estimated.
void completeFreeTurns(const Mechanism& mechanism, const Scene& scene,
                       const CompletionSettings& settings, MotionFile& file);

}  // namespace virtual_work_dynamics
