#pragma once

#include <cmath>
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

}  // namespace virtual_work_dynamics
