#include "robot/urdf_checks.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unordered_set>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "robot/urdf_tree.h"
#include "robot/urdf_xml.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;
using Words = std::vector<std::string>;

const Words kTypes = {"revolute", "continuous", "prismatic", "fixed", "floating", "planar"};
// Attributes that are read.
const Words kValue = {"value"};
const Words kMoments = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
const Words kXyz = {"xyz"}, kOrigin = {"xyz", "rpy"};
const Words kBounds = {"lower", "upper"}, kRates = {"effort", "velocity"};
const Words kLimit = {"lower", "upper", "effort", "velocity"};
const Words kDynamics = {"damping", "friction"};
const Words kFactors = {"multiplier", "offset"}, kMimic = {"joint", "multiplier", "offset"};
// Angles from here on are hardly radians: more than a turn and a half.
constexpr double kDegrees = 10;

Words split(const std::string& text) {
  std::istringstream stream(text);
  Words pieces;
  for (std::string piece; stream >> piece;) pieces.push_back(piece);
  return pieces;
}

// Copies the parts of one description.
class Checker {
 public:
  Checker(const XMLElement& robot, std::vector<Doubt>& doubts) : robot_(robot), doubts_(doubts) {}

  std::string check() {
    checkVersion();
    XMLElement* target = add(checked_, "robot");
    target->SetAttribute("name", attributeOf(robot_, "name").c_str());
    for (const XMLElement* link = robot_.FirstChildElement("link"); link;
         link = link->NextSiblingElement("link")) {
      copyLink(*link, *target);
    }
    for (const XMLElement* joint = robot_.FirstChildElement("joint"); joint;
         joint = joint->NextSiblingElement("joint")) {
      copyJoint(*joint, *target);
    }
    tree_.check();
    tinyxml2::XMLPrinter printer(nullptr, true);
    checked_.Print(&printer);
    return printer.CStr();
  }

 private:
  XMLElement* add(tinyxml2::XMLNode& parent, const char* name) {
    XMLElement* element = checked_.NewElement(name);
    parent.InsertEndChild(element);
    return element;
  }

  void checkVersion() const {
    const std::string version = attributeOf(robot_, "version");
    if (version.empty() || version == "1" || version == "1.0") return;
    throw UrdfError("version " + inQuotes(version) + " of URDF is not supported, only 1.0");
  }

  // The name of a link or joint, which must be there, and once only.
  std::string nameOf(const XMLElement& element, std::unordered_set<std::string>& seen) {
    const std::string kind = element.Name();
    const std::string name = attributeOf(element, "name");
    if (name.empty()) {
      const XMLElement* child = element.FirstChildElement("child");
      throw UrdfError(
          "the " + kind + " in line " + std::to_string(element.GetLineNum()) +
          (child ? " (of child link " + inQuotes(attributeOf(*child, "link")) + ")" : "") +
          ": has no name");
    }
    refuseXacro(name);
    if (!seen.insert(name).second) {
      throw UrdfError(kind + " " + inQuotes(name) + ": is described twice");
    }
    return name;
  }

  static void refuseXacro(const std::string& value) {
    if (isXacro(value)) throw UrdfError(xacroProblem(inQuotes(value)));
  }

  // Copies attributes with so many numbers each. Those that are required must be there.
  void copyNumbers(const std::string& who, const XMLElement& from, XMLElement& to,
                   const Words& names, std::size_t count, bool required) {
    for (const std::string& name : names) {
      const char* text = from.Attribute(name.c_str());
      if (!text) {
        if (required) throw UrdfError(who + ": <" + from.Name() + "> has no " + name);
        continue;
      }
      to.SetAttribute(name.c_str(), numbersOf(who + ": " + what(from, name), text, count).c_str());
    }
  }

  static std::string what(const XMLElement& element, const std::string& name) {
    return name == "value" ? element.Name() : element.Name() + (" " + name);
  }

  // The numbers of a text, with one blank between them.
  static std::string numbersOf(const std::string& where, const std::string& text,
                               std::size_t count) {
    refuseXacro(text);
    const Words pieces = split(text);
    std::string numbers;
    bool good = pieces.size() == count;
    for (const std::string& piece : pieces) {
      double value = 0;
      good = good && parseNumber(piece, value);
      numbers += (numbers.empty() ? "" : " ") + piece;
    }
    if (good) return numbers;
    const bool comma = text.find(',') != std::string::npos;
    const char* expected = count == 1 ? " is not a finite number" : " is not three finite numbers";
    throw UrdfError(where + " " + inQuotes(text) + expected +
                    (comma ? "; numbers have a decimal point, and blanks between them" : ""));
  }

  // Warns of attributes that are written almost like one that is read and is not there.
  void doubtAttributes(const std::string& who, const XMLElement& element, const Words& known) {
    Words missing;
    for (const std::string& name : known) {
      if (!element.Attribute(name.c_str())) missing.push_back(name);
    }
    for (const tinyxml2::XMLAttribute* attribute = element.FirstAttribute(); attribute;
         attribute = attribute->Next()) {
      const std::string name = attribute->Name();
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const std::string nearest = nearestName(name, missing);
      if (nearest.empty()) continue;
      doubts_.push_back({who + ": attribute " + inQuotes(name) + " of <" + element.Name() +
                         "> is not read; did you mean " + inQuotes(nearest) + "?"});
    }
  }

  void copyOrigin(const std::string& who, const XMLElement& from, XMLElement& to) {
    const XMLElement* origin = from.FirstChildElement("origin");
    if (!origin) return;
    doubtAttributes(who, *origin, kOrigin);
    if (origin->Attribute("quat_xyzw")) {
      throw UrdfError(who + ": origin quat_xyzw is not supported; write rpy");
    }
    copyNumbers(who, *origin, *add(to, "origin"), kXyz, 3, false);
    const std::string rpy = attributeOf(*origin, "rpy");
    if (rpy.empty()) return;
    const Words angles = split(numbersOf(who + ": origin rpy", rpy, 3));
    const bool degrees = std::any_of(angles.begin(), angles.end(), [](const std::string& text) {
      double angle = 0;
      return parseNumber(text, angle) && std::abs(angle) >= kDegrees;
    });
    if (degrees) {
      doubts_.push_back({who + ": origin rpy " + inQuotes(rpy) + " rad: are they degrees?"});
    }
  }

  void copyLink(const XMLElement& link, XMLElement& target) {
    const std::string name = nameOf(link, links_);
    XMLElement* copy = add(target, "link");
    copy->SetAttribute("name", name.c_str());
    tree_.addLink(name);
    const XMLElement* inertial = link.FirstChildElement("inertial");
    if (!inertial) return;
    const std::string who = "link " + inQuotes(name);
    if (inertial->NextSiblingElement("inertial")) {
      doubts_.push_back({who + ": has more than one <inertial>, the first is used"});
    }
    copyInertial(who, *inertial, *add(*copy, "inertial"));
  }

  void copyInertial(const std::string& who, const XMLElement& from, XMLElement& to) {
    copyOrigin(who, from, to);
    copyNumbers(who, child(who, from, "mass"), *add(to, "mass"), kValue, 1, true);
    copyNumbers(who, child(who, from, "inertia"), *add(to, "inertia"), kMoments, 1, true);
  }

  static const XMLElement& child(const std::string& who, const XMLElement& parent,
                                 const char* name) {
    const XMLElement* found = parent.FirstChildElement(name);
    if (!found) throw UrdfError(who + ": <" + parent.Name() + "> has no <" + name + ">");
    return *found;
  }

  void copyJoint(const XMLElement& joint, XMLElement& target) {
    const std::string name = nameOf(joint, joints_);
    const std::string who = "joint " + inQuotes(name);
    XMLElement* copy = add(target, "joint");
    copy->SetAttribute("name", name.c_str());
    const std::string type = typeOf(who, joint);
    copy->SetAttribute("type", type.c_str());
    const std::string parent = copyEnd(who, joint, "parent", *copy);
    const std::string child_link = copyEnd(who, joint, "child", *copy);
    tree_.addJoint(name, parent, child_link);
    copyOrigin(who, joint, *copy);
    if (type == "fixed" || type == "floating") return copyMimic(who, joint, *copy);
    if (const XMLElement* axis = joint.FirstChildElement("axis")) {
      copyNumbers(who + (axis->FirstChildElement("xyz") ? " (its <axis> is one of SDF)" : ""),
                  *axis, *add(*copy, "axis"), kXyz, 3, true);
    }
    copyLimit(who, type, joint, *copy);
    copyDynamics(who, joint, *copy);
    copyMimic(who, joint, *copy);
  }

  static std::string typeOf(const std::string& who, const XMLElement& joint) {
    const std::string type = attributeOf(joint, "type");
    if (type.empty()) throw UrdfError(who + ": has no type");
    refuseXacro(type);
    if (std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end()) return type;
    const bool of_scene =
        type == "cylindrical" || type == "universal" || type == "screw" || type == "spherical";
    const std::string nearest = nearestName(type, kTypes);
    throw UrdfError(who + ": type " + inQuotes(type) +
                    " is not one of revolute, continuous, prismatic, fixed, planar, floating" +
                    (of_scene ? "; 'joint_types' of a scene makes a joint of another type " + type
                     : nearest.empty() ? ""
                                       : "; did you mean " + inQuotes(nearest) + "?"));
  }

  std::string copyEnd(const std::string& who, const XMLElement& joint, const char* end,
                      XMLElement& to) {
    const XMLElement& element = child(who, joint, end);
    const std::string link = attributeOf(element, "link");
    if (link.empty()) {
      const std::string text = textOf(&element);
      throw UrdfError(
          who + ": <" + end + "> names no link" +
          (text.empty() ? ""
                        : "; " + inQuotes(text) + " as text is SDF, write <" + end + " link=...>"));
    }
    refuseXacro(link);
    add(to, end)->SetAttribute("link", link.c_str());
    return link;
  }

  void copyLimit(const std::string& who, const std::string& type, const XMLElement& joint,
                 XMLElement& to) {
    const XMLElement* limit = joint.FirstChildElement("limit");
    if (!limit) {
      if (type != "revolute" && type != "prismatic") return;
      throw UrdfError(who + ": a " + type + " joint needs a <limit>" +
                      (type == "revolute" ? "; without limits its type is continuous" : ""));
    }
    doubtAttributes(who, *limit, kLimit);
    XMLElement* copy = add(to, "limit");
    copyNumbers(who, *limit, *copy, kBounds, 1, false);
    copyNumbers(who, *limit, *copy, kRates, 1, true);
  }

  // Leaves out an empty element, which urdfdom refuses.
  void copyDynamics(const std::string& who, const XMLElement& joint, XMLElement& to) {
    const XMLElement* dynamics = joint.FirstChildElement("dynamics");
    if (!dynamics) return;
    doubtAttributes(who, *dynamics, kDynamics);
    if (!dynamics->Attribute("damping") && !dynamics->Attribute("friction")) return;
    copyNumbers(who, *dynamics, *add(to, "dynamics"), kDynamics, 1, false);
  }

  void copyMimic(const std::string& who, const XMLElement& joint, XMLElement& to) {
    const XMLElement* mimic = joint.FirstChildElement("mimic");
    if (!mimic) return;
    doubtAttributes(who, *mimic, kMimic);
    const std::string master = attributeOf(*mimic, "joint");
    if (master.empty()) throw UrdfError(who + ": <mimic> names no joint");
    refuseXacro(master);
    XMLElement* copy = add(to, "mimic");
    copy->SetAttribute("joint", master.c_str());
    copyNumbers(who, *mimic, *copy, kFactors, 1, false);
  }

  const XMLElement& robot_;
  std::vector<Doubt>& doubts_;
  XMLDocument checked_;
  std::unordered_set<std::string> links_, joints_;
  UrdfTree tree_;
};

}  // namespace

std::string checkedUrdf(const XMLElement& robot, std::vector<Doubt>& doubts) {
  return Checker(robot, doubts).check();
}

}  // namespace virtual_work_dynamics
