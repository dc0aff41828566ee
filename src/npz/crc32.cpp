#include "npz/crc32.h"

#include <array>

namespace virtual_work_dynamics {
namespace {

using Table = std::array<std::uint32_t, 256>;

constexpr Table tableOfBytes() {
  Table table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = rest % 2 == 1 ? 0xedb88320u ^ rest >> 1 : rest >> 1;
    table[byte] = rest;
  }
  return table;
}

constexpr Table kTable = tableOfBytes();

}  // namespace

std::uint32_t continuedCrc32(std::uint32_t crc, std::string_view bytes) {
  crc = ~crc;
  for (const char byte : bytes) {
    crc = kTable[(crc ^ static_cast<unsigned char>(byte)) & 0xff] ^ crc >> 8;
  }
  return ~crc;
}

}  // namespace virtual_work_dynamics
