#include "base/npy_header.h"

#include <cstdint>

namespace virtual_work_dynamics {
namespace {

bool isLittleEndian() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const unsigned char*>(&one) == 1;
}

}  // namespace

std::string npyHeader(const std::vector<std::size_t>& shape) {
  std::string text = std::string("{'descr': '") + (isLittleEndian() ? '<' : '>') +
                     "f8', 'fortran_order': False, 'shape': (";
  for (const std::size_t length : shape) text += std::to_string(length) + ",";
  text += "), }";
  constexpr std::size_t kBefore = 10, kAlignment = 64;  // magic, version and the text's length
  while ((kBefore + text.size() + 1) % kAlignment != 0) text += ' ';
  text += '\n';
  const auto length = static_cast<std::uint16_t>(text.size());
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(length & 0xff);
  header += static_cast<char>(length >> 8);
  return header + text;
}

}  // namespace virtual_work_dynamics
