#pragma once

#include <string>

namespace virtual_work_dynamics {

/// The whole content of a file. @throws FileError naming path and reason when it cannot be read.
std::string readTextFile(const std::string& path);

}  // namespace virtual_work_dynamics
