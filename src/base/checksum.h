#pragma once

#include <cstdint>
#include <string>

namespace virtual_work_dynamics {

/// The checksum of a text that the program `cksum` of POSIX prints.
std::uint32_t posixChecksum(const std::string& text);

}  // namespace virtual_work_dynamics
