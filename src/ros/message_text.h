#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "base/printable.h"

namespace virtual_work_dynamics {

/// Lists names for a message to the user, cut short after a few.
template <typename Names>
std::string shortList(const Names& names) {
  constexpr std::size_t kMost = 8;
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (count == kMost) return text + ", ... (" + std::to_string(names.size()) + " in all)";
    text += (count++ == 0 ? "" : ", ") + shortened(name);
  }
  return text;
}

/// Of ROS, in ns: a stamp has 32 bits for the seconds.
constexpr std::int64_t kLastStamp =
    (std::int64_t{std::numeric_limits<std::uint32_t>::max()} + 1) * 1000000000 - 1;

/// What a point of a trajectory is called: they count from 1.
inline std::string pointText(std::size_t point) {
  return "point " + std::to_string(point + 1);
}

/// A stamp in seconds with all nine decimals.
inline std::string stampText(std::int64_t stamp_ns) {
  std::string fraction = std::to_string(stamp_ns % 1000000000);
  fraction.insert(0, 9 - fraction.size(), '0');
  return std::to_string(stamp_ns / 1000000000) + "." + fraction;
}

}  // namespace virtual_work_dynamics
