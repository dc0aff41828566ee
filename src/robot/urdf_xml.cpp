#include "robot/urdf_xml.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

constexpr char kNamespace[] = "xmlns:xacro";
// What expanding a xacro file never leaves behind.
constexpr std::array<const char*, 7> kDefinitions{
    "xacro:macro", "xacro:property", "xacro:include",     "xacro:arg",
    "xacro:if",    "xacro:unless",   "xacro:insert_block"};

struct OtherFile {
  const char* root;
  const char* what;
};
constexpr std::array<OtherFile, 7> kOtherFiles{{{"sdf", "SDF"},
                                                {"model", "SDF"},
                                                {"world", "SDF"},
                                                {"mujoco", "MuJoCo's MJCF"},
                                                {"launch", "a launch file"},
                                                {"package", "a package.xml"},
                                                {"COLLADA", "a COLLADA file"}}};

// The words of tinyxml2's name of an error: "XML_ERROR_MISMATCHED_ELEMENT" becomes "mismatched
// element". Its own line repeats numbers that tell a user nothing.
std::string problemOf(const XMLDocument& document) {
  std::string name = document.ErrorName();
  for (const char* start : {"XML_ERROR_", "XML_"}) {
    if (name.compare(0, std::strlen(start), start) == 0) {
      name.erase(0, std::strlen(start));
      break;
    }
  }
  for (char& c : name) {
    c = c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  const int line = document.ErrorLineNum();
  return (line > 0 ? "line " + std::to_string(line) + ": " : "") + name;
}

// The first definition of xacro among all elements; null when there is none.
const XMLElement* definitionIn(const XMLElement& root) {
  for (const XMLElement* element = &root; element;) {
    const bool defines = std::any_of(
        kDefinitions.begin(), kDefinitions.end(),
        [&](const char* definition) { return std::strcmp(definition, element->Name()) == 0; });
    if (defines) return element;
    const tinyxml2::XMLNode* next = element->FirstChildElement();
    for (const tinyxml2::XMLNode* up = element; !next && up && up != &root; up = up->Parent()) {
      next = up->NextSiblingElement();
    }
    element = next ? next->ToElement() : nullptr;
  }
  return nullptr;
}

[[noreturn]] void refuseRoot(const XMLElement& root) {
  const std::string name = root.Name();
  for (const OtherFile& other : kOtherFiles) {
    if (name != other.root) continue;
    throw UrdfError(std::string("this is ") + other.what + " (its root element is <" + name +
                    ">), not URDF");
  }
  throw UrdfError("robot description is broken: its root element is <" + shortened(name) +
                  ">, not <robot>");
}

}  // namespace

std::string attributeOf(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? value : "";
}

std::string textOf(const XMLElement* element) {
  const char* text = element ? element->GetText() : nullptr;
  if (!text) return "";
  const std::string whole = text;
  const std::size_t first = whole.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return whole.substr(first, whole.find_last_not_of(" \t\r\n") - first + 1);
}

std::string shown(const XMLElement& element) {
  const std::string name = attributeOf(element, "name");
  return "<" + shortened(element.Name()) + (name.empty() ? "" : " name=" + inQuotes(name)) + ">";
}

std::string xacroProblem(const std::string& found) {
  return "this is a xacro file (it has " + found +
         "): expand it first, rosrun xacro xacro FILE > robot.urdf";
}

bool isXacro(const std::string& value) {
  return value.find("${") != std::string::npos || value.find("$(") != std::string::npos;
}

const XMLElement& parseUrdfXml(const std::string& urdf, XMLDocument& document) {
  if (urdf.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw UrdfError("robot description is empty");
  }
  const std::string start = urdf.substr(0, 2);
  if (start == "\xff\xfe" || start == "\xfe\xff") {
    throw UrdfError("robot description is broken: it is UTF-16, write it as UTF-8");
  }
  if (document.Parse(urdf.c_str(), urdf.size()) != tinyxml2::XML_SUCCESS) {
    throw UrdfError("robot description is broken: not well-formed XML: " + problemOf(document));
  }
  const XMLElement* root = document.RootElement();
  if (!root) throw UrdfError("robot description is broken: no <robot> element");
  const std::string root_name = root->Name();
  if (root_name != "robot") refuseRoot(*root);
  if (const XMLElement* definition = definitionIn(*root)) {
    throw UrdfError(xacroProblem(shown(*definition)));
  }
  const bool links = root->FirstChildElement("link") != nullptr;
  const bool named = root->Attribute("name") != nullptr;
  if (root->Attribute(kNamespace) && (!links || !named)) {
    throw UrdfError(
        xacroProblem(std::string(kNamespace) + ", but no " + (links ? "name" : "link of its own")));
  }
  if (!named) throw UrdfError("the robot has no name: <robot name=\"...\">");
  const std::string name = attributeOf(*root, "name");
  if (isXacro(name)) throw UrdfError(xacroProblem(inQuotes(name)));
  if (!links) throw UrdfError("robot " + inQuotes(name) + " has no <link>");
  return *root;
}

}  // namespace virtual_work_dynamics
