#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace virtual_work_dynamics {

// Little-endian values, as ByteCursor reads them.

inline void appendWhole(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}
inline void appendWord(std::string& bytes, std::uint32_t value) {
  appendWhole(bytes, value, 4);
}
inline void appendLongWord(std::string& bytes, std::uint64_t value) {
  appendWhole(bytes, value, 8);
}
/// A time of ROS: seconds, then nanoseconds. @param ns not negative
inline void appendTime(std::string& bytes, std::int64_t ns) {
  appendWord(bytes, static_cast<std::uint32_t>(ns / 1000000000));
  appendWord(bytes, static_cast<std::uint32_t>(ns % 1000000000));
}
/// Bytes behind their number, a word.
inline void appendSized(std::string& bytes, std::string_view content) {
  appendWord(bytes, static_cast<std::uint32_t>(content.size()));
  bytes += content;
}

}  // namespace virtual_work_dynamics
