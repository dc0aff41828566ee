#pragma once

#include <cstddef>

namespace virtual_work_dynamics {

/// Alignment of memory for vector instructions, bytes: the width of the widest of them.
constexpr std::size_t kVectorAlignment = 64;

}  // namespace virtual_work_dynamics
