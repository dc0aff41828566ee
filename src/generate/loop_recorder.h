#pragma once

#include "generate/recorder.h"

namespace virtual_work_dynamics {

struct LoopModel;

/// Records what ClosedLoopDynamics computes of a sample in a regular position: the kernels of loops
/// and of their factorization once on terms, in the order of elimination that does not depend on
/// the position. What does depend on it is chosen beside the assembly, and required of every
/// sample; so is all by which compute() tells that a position is regular. Where a sample fails, its
/// results are zero and the last output, `status`, is 2.
/// @throws SceneError in one line where there is no straight line.
RecordedPlan recordLoops(const LoopModel& model);

}  // namespace virtual_work_dynamics
