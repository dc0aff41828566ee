#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "virtual_work_dynamics/number_text.h"

namespace virtual_work_dynamics {

/// A number for a message to the user, finite or not.
inline std::string numberText(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text;
  appendNumber(text, value);
  return text;
}

/// Names as a list for a message to the user, cut short after a few.
template <typename Names>
std::string shortList(const Names& names) {
  constexpr std::size_t kMost = 8;
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (count == kMost) return text + ", ... (" + std::to_string(names.size()) + " in all)";
    text += (count++ == 0 ? "" : ", ") + name;
  }
  return text;
}

}  // namespace virtual_work_dynamics
