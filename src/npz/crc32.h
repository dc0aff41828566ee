#pragma once

#include <cstdint>
#include <string_view>

namespace virtual_work_dynamics {

/// Continues the CRC-32 of a zip file (ISO 3309, polynomial 0xedb88320 in reversed order).
/// @param crc of the bytes before; 0: there are none
std::uint32_t continuedCrc32(std::uint32_t crc, std::string_view bytes);

}  // namespace virtual_work_dynamics
