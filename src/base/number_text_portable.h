#pragma once

#include <string>

namespace virtual_work_dynamics {
namespace portable {

/// appendNumber() and parseNumber() for standard libraries without floating-point <charconv>;
/// always compiled, so that tests can hold them against the other way. At powers of two the text
/// may have one digit more than the shortest.
void appendNumber(std::string& text, double value);
bool parseNumber(const std::string& text, double& value);

}  // namespace portable
}  // namespace virtual_work_dynamics
