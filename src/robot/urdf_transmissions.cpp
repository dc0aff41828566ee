#include "robot/urdf_transmissions.h"

#include <algorithm>
#include <cstddef>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "robot/urdf_xml.h"

namespace virtual_work_dynamics {

namespace {

using tinyxml2::XMLElement;
using Words = std::vector<std::string>;

const std::string kPackage = "transmission_interface/";
const char* const kReduction = "mechanicalReduction";

// What a class of transmission_interface has.
struct KnownType {
  const char* name;
  std::size_t ends;  // joints, and as many actuators
};

constexpr KnownType kTransmissionTypes[] = {
    {"SimpleTransmission", 1}, {"DifferentialTransmission", 2}, {"FourBarLinkageTransmission", 2}};

// Transmissions name their joints in elements that are called joint, rollJoint or gap_joint.
Words coupledJoints(const XMLElement& transmission) {
  Words joints;
  for (const XMLElement* child = transmission.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const std::string tag = child->Name();
    const std::string end = tag.size() < 5 ? "" : tag.substr(tag.size() - 5);
    const std::string name = attributeOf(*child, "name");
    const bool known = std::find(joints.begin(), joints.end(), name) != joints.end();
    if ((end == "joint" || end == "Joint") && !name.empty() && !known) joints.push_back(name);
  }
  return joints;
}

// Reads one transmission; the first thing that is wrong with it is its problem.
class TransmissionReader {
 public:
  explicit TransmissionReader(const XMLElement& element) {
    result_.name = attributeOf(element, "name");
    const XMLElement* const type = element.FirstChildElement("type");
    result_.type = type ? textOf(type) : attributeOf(element, "type");
    if (result_.type.compare(0, kPackage.size(), kPackage) == 0) {
      result_.type.erase(0, kPackage.size());
    }
    const auto known = std::find_if(std::begin(kTransmissionTypes), std::end(kTransmissionTypes),
                                    [&](const KnownType& t) { return result_.type == t.name; });
    if (known == std::end(kTransmissionTypes)) {
      failForType();
      return;
    }
    const std::size_t ends = known->ends;
    result_.joints = read(element, "joint", ends, ends == 1 ? Need::kNothing : Need::kRole);
    result_.actuators =
        read(element, "actuator", ends, ends == 1 ? Need::kNumber : Need::kNumberAndRole);
    if (result_.joints.size() != ends || result_.actuators.size() != ends) {
      fail("a " + result_.type + " has " +
           (ends == 1 ? "one joint and one actuator" : "two joints and two actuators"));
    }
  }

  Transmission result() { return std::move(result_); }

 private:
  // What an end has to have besides its name.
  enum class Need { kNothing, kRole, kNumber, kNumberAndRole };

  void fail(const std::string& problem) {
    if (result_.problem.empty()) result_.problem = problem;
  }

  void failForType() {
    Words names;
    for (const KnownType& type : kTransmissionTypes) names.emplace_back(type.name);
    fail("its type " + inQuotes(result_.type) + " is not known" + nameHelp(result_.type, names));
  }

  double number(const XMLElement& end, const std::string& who, const char* key, double otherwise) {
    const XMLElement* const found = end.FirstChildElement(key);
    double value = otherwise;
    if (found && !parseNumber(textOf(found), value)) {
      fail("<" + std::string(key) + "> of " + who + " is " + inQuotes(textOf(found)) +
           ", and not a number");
    }
    return value;
  }

  // The ends, each at the place that its role says.
  std::vector<TransmissionEnd> read(const XMLElement& element, const std::string& tag,
                                    std::size_t count, Need need) {
    const bool simple = count == 1;
    std::vector<TransmissionEnd> ends;
    Words roles;
    for (const XMLElement* child = element.FirstChildElement(tag.c_str()); child;
         child = child->NextSiblingElement(tag.c_str())) {
      TransmissionEnd end;
      end.name = attributeOf(*child, "name");
      const std::string who = tag + " " + inQuotes(end.name);
      if (end.name.empty()) fail("its " + tag + " has no name");
      // transmission_interface does not look at the reduction of the joint of a simple one.
      if (!simple || tag == "actuator") end.reduction = number(*child, who, kReduction, 1);
      const bool has_number = child->FirstChildElement(kReduction) != nullptr;
      if ((need == Need::kNumber || need == Need::kNumberAndRole) && !has_number) {
        fail(who + " has no <" + kReduction + ">");
      }
      if (end.reduction == 0) fail("<" + std::string(kReduction) + "> of " + who + " is zero");
      if (tag == "joint") end.offset = number(*child, who, "offset", 0);
      roles.push_back(textOf(child->FirstChildElement("role")));
      ends.push_back(end);
    }
    if (!simple && ends.size() == count) sortByRole(tag, roles, ends);
    return ends;
  }

  void sortByRole(const std::string& tag, const Words& roles, std::vector<TransmissionEnd>& ends) {
    std::vector<TransmissionEnd> sorted;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const std::string role = tag + std::to_string(i + 1);
      const auto found = std::find(roles.begin(), roles.end(), role);
      if (found == roles.end()) {
        fail("none of its " + tag + "s has the <role> " + role);
        return;
      }
      sorted.push_back(ends[static_cast<std::size_t>(found - roles.begin())]);
    }
    ends = sorted;
  }

  Transmission result_;
};

}  // namespace

std::string unreadText(const XMLElement& transmission) {
  const Words joints = coupledJoints(transmission);
  if (joints.size() < 2) return "";
  const Transmission read = TransmissionReader(transmission).result();
  return "element " + shown(transmission) + " is not read: it couples the joints " +
         namesInQuotes(joints) +
         "; efforts are those at the joints, not at its motors, and where it ties joints to one "
         "another, " +
         (read.problem.empty() ? "urdf_transmissions in the scene says so"
                               : "<mimic> in the joint or couplings in the scene say so");
}

std::vector<Transmission> transmissionsOf(const XMLElement& robot) {
  std::vector<Transmission> all;
  for (const XMLElement* element = robot.FirstChildElement("transmission"); element;
       element = element->NextSiblingElement("transmission")) {
    all.push_back(TransmissionReader(*element).result());
    all.back().unread = unreadText(*element);
  }
  return all;
}

}  // namespace virtual_work_dynamics
