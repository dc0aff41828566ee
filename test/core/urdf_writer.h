#pragma once

#include <cmath>
#include <string>

#include "base/number_text.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Writes a mechanism as URDF text from which readUrdf() makes the same tree. Every number is the
/// double nearest to the mechanism's; orientations become angles. Joints must be named so that the
/// mechanism's order is the reader's.
class UrdfWriter {
 public:
  explicit UrdfWriter(const Mechanism& mechanism) : mechanism_(mechanism) {
    text_ = "<robot name='" + mechanism.name() + "'>\n";
    for (const Link& link : mechanism.links()) add(link);
    for (const Joint& joint : mechanism.joints()) add(joint);
    text_ += "</robot>\n";
  }

  const std::string& text() const { return text_; }

  /// Angles about fixed axes, R = Rz(yaw) Ry(pitch) Rx(roll). Where pitch is a quarter turn, only
  /// the sum or difference of the others is determined; roll is then the remainder for the yaw
  /// found.
  static Vector3l anglesOf(const Matrix3l& R) {
    const long double yaw = std::atan2(R(1, 0), R(0, 0));
    const long double s = std::sin(yaw), c = std::cos(yaw);
    return {std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1)),
            std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0)), yaw};
  }

 private:
  static std::string number(long double value) { return numberText(static_cast<double>(value)); }
  static std::string attribute(const char* name, const std::string& value) {
    return std::string(" ") + name + "='" + value + "'";
  }
  static std::string attribute(const char* name, const Vector3l& v) {
    return attribute(name, number(v[0]) + " " + number(v[1]) + " " + number(v[2]));
  }

  void add(const Link& link) {
    text_ += "  <link" + attribute("name", link.name);
    if (link.mass == 0 && link.p_KoCm_K.isZero(0) && link.inertia_Cm_K.isZero(0)) {
      text_ += "/>\n";
      return;
    }
    const Matrix3l& I = link.inertia_Cm_K;
    text_ += "><inertial><origin" + attribute("xyz", link.p_KoCm_K) + "/><mass" +
             attribute("value", number(link.mass)) + "/>\n    <inertia" +
             attribute("ixx", number(I(0, 0))) + attribute("ixy", number(I(0, 1))) +
             attribute("ixz", number(I(0, 2))) + attribute("iyy", number(I(1, 1))) +
             attribute("iyz", number(I(1, 2))) + attribute("izz", number(I(2, 2))) +
             "/></inertial></link>\n";
  }

  void add(const Joint& joint) {
    static const char* const kTypes[] = {"revolute", "continuous", "prismatic", "fixed"};
    text_ += "  <joint" + attribute("name", joint.name) +
             attribute("type", kTypes[static_cast<int>(joint.type)]) + "><parent" +
             attribute("link", mechanism_.links()[joint.parent_link].name) + "/><child" +
             attribute("link", mechanism_.links()[joint.child_link].name) + "/>\n    <origin" +
             attribute("xyz", joint.p_PoKo_P) + attribute("rpy", anglesOf(joint.R_PK)) + "/>";
    if (joint.type != JointType::kFixed) {
      // urdfdom refuses revolute and prismatic joints without limits; they mean nothing here.
      text_ += "<axis" + attribute("xyz", joint.axis_K) +
               "/><limit lower='-1' upper='1' effort='1' velocity='1'/>";
    }
    if (joint.damping != 0 || joint.friction != 0) {
      text_ += "<dynamics" + attribute("damping", numberText(joint.damping)) +
               attribute("friction", numberText(joint.friction)) + "/>";
    }
    if (joint.mimics) {
      text_ += "<mimic" + attribute("joint", mechanism_.coordinateNames()[joint.coordinate]) +
               attribute("multiplier", numberText(joint.multiplier)) +
               attribute("offset", numberText(joint.offset)) + "/>";
    }
    text_ += "</joint>\n";
  }

  const Mechanism& mechanism_;
  std::string text_;
};

/// The URDF text of a mechanism, as UrdfWriter writes it.
inline std::string urdfText(const Mechanism& mechanism) {
  return UrdfWriter(mechanism).text();
}

}  // namespace virtual_work_dynamics
