#pragma once

#include <string>

namespace virtual_work_dynamics {

/// A slide, a wrist that a differential moves, and an elbow and forearm that are moved remotely,
/// with `more` in the description: all joints in one chain, in general position.
inline std::string transmittingRobot(const std::string& more) {
  const auto link = [](const std::string& name, const std::string& mass, const std::string& at) {
    return "<link name='" + name + "'><inertial><origin xyz='" + at + "'/><mass value='" + mass +
           "'/><inertia ixx='0.011' iyy='0.013' izz='0.009' ixy='0.001' ixz='-0.002' "
           "iyz='0.0005'/></inertial></link>";
  };
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& axis) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='0.1 -0.05 0.2' rpy='0.3 -0.2 0.5'/>" +
           "<axis xyz='" + axis + "'/><limit lower='-3' upper='3' effort='90' velocity='5'/>" +
           "<dynamics damping='0.3'/></joint>";
  };
  return "<robot name='transmitting'><link name='base'/>" + link("sled", "4", "0.1 0 0") +
         joint("slide", "prismatic", "base", "sled", "1 0 0") + link("upper", "3", "0 0.1 0.05") +
         joint("shoulder", "revolute", "sled", "upper", "0 1 0") + link("fore", "2", "0.1 0 0.2") +
         joint("elbow", "revolute", "upper", "fore", "0 0.6 0.8") + link("hand", "1", "0 0.05 0") +
         joint("pitch", "revolute", "fore", "hand", "1 0 0") + link("tool", "0.5", "0.05 0 0.1") +
         joint("roll", "continuous", "hand", "tool", "0 0 1") + more + "</robot>";
}

/// A <transmission> of a class of transmission_interface; the ends are elements as below.
inline std::string transmissionText(const std::string& name, const std::string& type,
                                    const std::string& ends) {
  return "<transmission name='" + name + "'><type>" + type + "</type>" + ends + "</transmission>";
}

/// A <joint> or <actuator> of a transmission. What is empty is left out.
inline std::string endText(const std::string& tag, const std::string& name,
                           const std::string& reduction, const std::string& role = "",
                           const std::string& offset = "") {
  const auto element = [](const std::string& key, const std::string& value) {
    return value.empty() ? "" : "<" + key + ">" + value + "</" + key + ">";
  };
  return "<" + tag + " name='" + name +
         "'><hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>" +
         element("role", role) + element("mechanicalReduction", reduction) +
         element("offset", offset) + "</" + tag + ">";
}

}  // namespace virtual_work_dynamics
