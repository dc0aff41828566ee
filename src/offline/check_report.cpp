#include "offline/check_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/scene_units.h"
#include "virtual_work_dynamics/joint_types.h"

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
  const auto add = [&](int count, const char* name) {
    if (count > 0) text << (text.tellp() > 0 ? ", " : "") << count << " " << name;
  };
  const int joints = static_cast<int>(mechanism.joints().size());
  for (const TypeText& type : kTypes) {
    int count = 0;
    for (int k = 0; k < joints; ++k) {
      if (!mechanism.compoundOf(k) && mechanism.joint(k).type == type.type) ++count;
    }
    add(count, type.name);
  }
  std::map<CompoundType, int> compounds;
  for (const CompoundJoint& compound : mechanism.compounds()) ++compounds[compound.type];
  for (const auto& [type, count] : compounds) add(count, nameOf(type));
  return text.tellp() > 0 ? text.str() : "none";
}

void printMimicJoints(std::ostream& out, const Mechanism& mechanism) {
  std::vector<std::string> rules;
  for (int k = 0; k < static_cast<int>(mechanism.joints().size()); ++k) {
    const Joint& joint = mechanism.joint(k);
    if (!joint.mimics || mechanism.isInnerPart(k)) continue;
    const std::string& master = mechanism.jointOf(joint.coordinate).name;
    std::ostringstream rule;
    rule << shortened(joint.name) << " = " << joint.multiplier << " " << shortened(master);
    if (joint.offset != 0) rule << (joint.offset < 0 ? " - " : " + ") << std::abs(joint.offset);
    rules.push_back(rule.str());
  }
  printNames(out, "mimic joints", rules);
}

// The type of the joint that a coordinate belongs to.
const char* typeOf(const Mechanism& mechanism, int joint) {
  const CompoundJoint* const compound = mechanism.compoundOf(joint);
  return compound ? nameOf(compound->type) : nameOf(mechanism.joint(joint).type);
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
        << std::setw(12) << typeOf(mechanism, index) << symbolOf(unitOf(joint)) << "\n";
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
  std::size_t between = 0;  // links within compound joints
  for (const CompoundJoint& compound : mechanism.compounds()) {
    between += static_cast<std::size_t>(compound.last - compound.first);
  }
  label(out, "links") << mechanism.links().size() - between << ", root "
                      << shortened(mechanism.link(0).name) << "\n";
  label(out, "joints") << jointCounts(mechanism) << "\n";
  label(out, "total mass") << mass << " kg\n";
  printMimicJoints(out, mechanism);
  printCoordinates(out, mechanism);
}

void printGravity(std::ostream& out, const Scene& scene) {
  const Eigen::Vector3d& g = scene.gravity;
  label(out, "gravity") << numberText(g.x()) << " " << numberText(g.y()) << " " << numberText(g.z())
                        << " m/s^2\n";
}

void printSceneDoubts(std::ostream& out, const std::string& prefix, const Mechanism& mechanism,
                      const Scene& scene) {
  for (const std::string& doubt : sceneUnitDoubts(mechanism, scene)) {
    out << "warning: " << printable(prefix + doubt) << "\n";
  }
}

void printDoubts(std::ostream& out, const Mechanism& mechanism) {
  for (const Doubt& doubt : mechanism.doubts()) out << "warning: " << printable(doubt.text) << "\n";
}

}  // namespace virtual_work_dynamics
