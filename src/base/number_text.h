#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace virtual_work_dynamics {

/// Appends the shortest decimal text that reads back as exactly `value` (which must be finite).
void appendNumber(std::string& text, double value);

/// The text of a number for messages to the user: as appendNumber(), or "nan", "inf" or "-inf".
std::string numberText(double value);

/// Appends nanoseconds as seconds, with all nine places.
void appendSeconds(std::string& text, std::int64_t ns);

/// Whether a text stands for a number that is infinite or none, as programs write it.
bool isNotANumber(std::string_view text);

/// Reads a whole text as one finite number, independently of the locale; blanks around it are
/// allowed.
/// @returns false when the text is anything else, or the number overflows.
bool parseNumber(const std::string& text, double& value);

}  // namespace virtual_work_dynamics
