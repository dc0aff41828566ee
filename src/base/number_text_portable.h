#pragma once

#include <string>

namespace virtual_work_dynamics {
namespace portable {

/// Appends a number for standard libraries without floating-point <charconv>; always compiled, so
/// that tests can compare it with virtual_work_dynamics::appendNumber(). At powers of two the text
/// may have one digit more than the shortest.
void appendNumber(std::string& text, double value);
/// Reads a number like virtual_work_dynamics::parseNumber(), without <charconv>.
bool parseNumber(const std::string& text, double& value);

}  // namespace portable
}  // namespace virtual_work_dynamics
