#include "npz/npy_header.h"

#include "npz/npz_format.h"

namespace virtual_work_dynamics {

std::string npyHeader(const char* type, const std::vector<std::size_t>& shape) {
  std::string text = std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (";
  for (const std::size_t length : shape) text += std::to_string(length) + ",";
  text += "), }";
  constexpr std::size_t kAlignment = 64, kBefore = 10;  // magic, version and the text's length
  text.append(kAlignment - 1 - (kBefore + text.size()) % kAlignment, ' ');
  text += '\n';
  std::string header = npz::kMagic;
  header += '\1';  // version 1.0
  header += '\0';
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

}  // namespace virtual_work_dynamics
