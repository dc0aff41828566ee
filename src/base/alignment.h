#pragma once

#include <cstddef>

namespace virtual_work_dynamics {

/// Bytes to which memory for vector instructions is aligned: the widest of them.
constexpr std::size_t kVectorAlignment = 64;

}  // namespace virtual_work_dynamics
