#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// What a file begins with that NumPy reads as an array of doubles, row after row (format 1.0, 64
/// bytes aligned); the numbers follow as they lie in memory.
std::string npyHeader(const std::vector<std::size_t>& shape);

}  // namespace virtual_work_dynamics
