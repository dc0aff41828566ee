#include "base/checksum.h"

#include <cstddef>

namespace virtual_work_dynamics {

std::uint32_t posixChecksum(const std::string& text) {
  std::uint32_t remainder = 0;
  const auto take = [&](unsigned byte) {
    remainder ^= static_cast<std::uint32_t>(byte) << 24;
    for (int bit = 0; bit < 8; ++bit) {
      const bool high = (remainder & 0x80000000u) != 0;
      remainder = (remainder << 1) ^ (high ? 0x04c11db7u : 0u);
    }
  };
  for (const char c : text) take(static_cast<unsigned char>(c));
  for (std::size_t size = text.size(); size > 0; size >>= 8) take(size & 0xff);
  return ~remainder;
}

}  // namespace virtual_work_dynamics
