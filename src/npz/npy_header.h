#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// What a .npy begins with, whose values follow row after row (format 1.0, filled up so that they
/// are aligned to 64 bytes).
/// @param type of the values, such as "<f8", doubles from their least byte on
std::string npyHeader(const char* type, const std::vector<std::size_t>& shape);

}  // namespace virtual_work_dynamics
