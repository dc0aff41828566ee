#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The transmissions of a description, in its order.
std::vector<Transmission> transmissionsOf(const tinyxml2::XMLElement& robot);

/// The doubt about a transmission of several joints that is not read; empty for others.
std::string unreadText(const tinyxml2::XMLElement& transmission);

}  // namespace virtual_work_dynamics
