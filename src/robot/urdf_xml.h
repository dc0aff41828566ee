#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Parses the text of a description.
/// @param document receives it; it owns what is returned.
/// @returns the <robot> element, which has a name and a link.
/// @throws UrdfError, one line that begins with the cause: not XML, a xacro file that was not
///   expanded, another kind of file.
const tinyxml2::XMLElement& parseUrdfXml(const std::string& urdf, tinyxml2::XMLDocument& document);

/// The value of an attribute; empty when there is none.
std::string attributeOf(const tinyxml2::XMLElement& element, const char* name);

/// The text inside an element without blanks around it; empty when there is none.
std::string textOf(const tinyxml2::XMLElement* element);

/// How messages name an element: "<joint name='hinge'>".
std::string shown(const tinyxml2::XMLElement& element);

/// The error for a value that still is an expression of xacro.
std::string xacroProblem(const std::string& found);

/// Whether a value still is an expression of xacro: it has ${...} or $(...).
bool isXacro(const std::string& value);

}  // namespace virtual_work_dynamics
