#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Prints what a robot description says: links, joints by type, mass, mimic joints, and the
/// coordinates in the order of the results with their units.
void printMechanism(std::ostream& out, const Mechanism& mechanism);

/// Prints names on one line after a label, or "none".
void printNames(std::ostream& out, const std::string& label, const std::vector<std::string>& names);

/// Prints one `warning:` line for each doubt about the description.
void printDoubts(std::ostream& out, const Mechanism& mechanism);

}  // namespace virtual_work_dynamics
