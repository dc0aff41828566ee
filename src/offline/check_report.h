#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Prints what a robot description says: links, joints by type, mass, mimic joints, and the
/// coordinates in the order of the results with their units.
void printMechanism(std::ostream& out, const Mechanism& mechanism);

/// Prints the gravity of a scene.
void printGravity(std::ostream& out, const Scene& scene);

/// Prints names on one line after a label, or "none".
void printNames(std::ostream& out, const std::string& label, const std::vector<std::string>& names);

/// Prints one `warning:` line for each doubt about the description.
void printDoubts(std::ostream& out, const Mechanism& mechanism);

/// Prints one `warning:` line for each number of a scene that seems to be in another unit.
/// @param prefix the scene's name and a colon, or nothing
void printSceneDoubts(std::ostream& out, const std::string& prefix, const Mechanism& mechanism,
                      const Scene& scene);

}  // namespace virtual_work_dynamics
