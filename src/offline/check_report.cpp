#include "offline/check_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kLabelWidth = 14;

struct TypeText {
  JointType type;
  const char* name;
};

constexpr std::array<TypeText, 4> kTypes{{{JointType::kRevolute, "revolute"},
                                          {JointType::kContinuous, "continuous"},
                                          {JointType::kPrismatic, "prismatic"},
                                          {JointType::kFixed, "fixed"}}};

const char* nameOf(JointType type) {
  return std::find_if(kTypes.begin(), kTypes.end(),
                      [&](const TypeText& text) { return text.type == type; })
      ->name;
}

std::ostream& label(std::ostream& out, const std::string& name) {
  return out << std::left << std::setw(kLabelWidth) << name + ":";
}

std::string jointCounts(const Mechanism& mechanism) {
  std::ostringstream text;
  for (const TypeText& type : kTypes) {
    const auto count = std::count_if(mechanism.joints().begin(), mechanism.joints().end(),
                                     [&](const Joint& joint) { return joint.type == type.type; });
    if (count > 0) text << (text.tellp() > 0 ? ", " : "") << count << " " << type.name;
  }
  return text.tellp() > 0 ? text.str() : "none";
}

void printMimicJoints(std::ostream& out, const Mechanism& mechanism) {
  std::vector<std::string> rules;
  for (const Joint& joint : mechanism.joints()) {
    if (!joint.mimics) continue;
    const std::string& master = mechanism.jointOf(joint.coordinate).name;
    std::ostringstream rule;
    rule << shortened(joint.name) << " = " << joint.multiplier << " " << shortened(master);
    if (joint.offset != 0) rule << (joint.offset < 0 ? " - " : " + ") << std::abs(joint.offset);
    rules.push_back(rule.str());
  }
  printNames(out, "mimic joints", rules);
}

void printCoordinates(std::ostream& out, const Mechanism& mechanism) {
  label(out, "coordinates") << mechanism.coordinates().size() << "\n";
  std::size_t longest = 0;
  for (const std::string& name : mechanism.coordinateNames()) {
    longest = std::max(longest, shortened(name).size());
  }
  for (const int index : mechanism.coordinates()) {
    const Joint& joint = mechanism.joint(index);
    out << "  " << std::left << std::setw(static_cast<int>(longest) + 2) << shortened(joint.name)
        << std::setw(12) << nameOf(joint.type) << symbolOf(unitOf(joint)) << "\n";
  }
}

}  // namespace

void printNames(std::ostream& out, const std::string& name, const std::vector<std::string>& names) {
  label(out, name);
  for (std::size_t i = 0; i < names.size(); ++i) out << (i > 0 ? ", " : "") << printable(names[i]);
  out << (names.empty() ? "none" : "") << "\n";
}

void printMechanism(std::ostream& out, const Mechanism& mechanism) {
  long double mass = 0;
  for (const Link& link : mechanism.links()) mass += link.mass;
  label(out, "robot") << shortened(mechanism.name()) << "\n";
  label(out, "links") << mechanism.links().size() << ", root " << shortened(mechanism.link(0).name)
                      << "\n";
  label(out, "joints") << jointCounts(mechanism) << "\n";
  label(out, "total mass") << mass << " kg\n";
  printMimicJoints(out, mechanism);
  printCoordinates(out, mechanism);
}

void printDoubts(std::ostream& out, const Mechanism& mechanism) {
  for (const Doubt& doubt : mechanism.doubts()) out << "warning: " << printable(doubt.text) << "\n";
}

}  // namespace virtual_work_dynamics
