#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace virtual_work_dynamics {

/// Text from outside for a message of one line: control characters, what is not UTF-8, and
/// characters that break or reverse a line stand as \n, \x1b or \u202e.
std::string printable(std::string_view text);

/// A name or value from outside as a message shows it: printable(), and cut when it is long.
std::string shortened(std::string_view name);

/// A shortened() name in single quotes.
std::string inQuotes(std::string_view name);

/// Words with commas between them.
std::string joined(const std::vector<std::string>& words);

/// Names as "'a', 'b' and 3 more", cut after a few; "none" when there are none.
std::string namesInQuotes(const std::vector<std::string>& names);

}  // namespace virtual_work_dynamics
