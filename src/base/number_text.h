#pragma once

#include <string>

namespace virtual_work_dynamics {

/// Appends the shortest decimal text that reads back as exactly `value` (which must be finite).
void appendNumber(std::string& text, double value);

/// The same as a text of its own, for messages to the user: "nan", "inf" and "-inf" exist, too.
std::string numberText(double value);

/// Reads a whole text as one finite number, independent of the locale; blanks around it are
/// allowed.
/// @returns false when the text is anything else, or overflows.
bool parseNumber(const std::string& text, double& value);

}  // namespace virtual_work_dynamics
