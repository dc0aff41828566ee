#pragma once

#include "offline/motion_file.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Checks what a file gives of the motion of the root link against what the scene needs, and warns
/// on standard error where it is not used, or was not quite an orientation.
/// @throws FileError naming columns that are missing.
void checkRoots(const Scene& scene, const MotionFile& file);

/// Estimates the rates and accelerations of the root that a file lacks, with notes on standard
/// error; see the core's completeRoots(). Does nothing in static scenes.
/// @throws FileError when the times or rows do not allow that.
void completeRoots(const Mechanism& mechanism, const Scene& scene,
                   const CompletionSettings& settings, MotionFile& file);

}  // namespace virtual_work_dynamics
