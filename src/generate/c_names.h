#pragma once

#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// A legal identifier of C and C++ for a name: letters, digits and underscores of it, others as _.
std::string identifierOf(const std::string& name);

/// Identifiers in capitals for names, in their order and all different: PREFIX_NAME, with _2, _3
/// ... behind those that others have already.
std::vector<std::string> constantNames(const std::string& prefix,
                                       const std::vector<std::string>& names);

std::string inCapitals(std::string text);

/// A text as a literal of C.
std::string cString(const std::string& text);

/// A text as part of a comment of C, in one line.
std::string inComment(const std::string& text);

/// A number as a literal that reads back equal.
std::string cNumber(double value);

}  // namespace virtual_work_dynamics
