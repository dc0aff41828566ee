#pragma once

namespace virtual_work_dynamics {

/// Keeps the calling thread, and threads it starts, on one of the cores that the process may use.
/// @returns the core; -1 when the system refuses.
int stayOnOneCore();

/// Lets the calling thread use all cores again that the process could use at its start.
void useAllCores();

}  // namespace virtual_work_dynamics
