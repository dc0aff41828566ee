#include "robot/urdf_angles.h"

#include <array>
#include <cmath>
#include <sstream>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// The rotation by roll, pitch and yaw about fixed axes: Rz(yaw) Ry(pitch) Rx(roll).
Matrix3l rotationOf(const std::array<long double, 3>& rpy) {
  const long double cr = std::cos(rpy[0]), sr = std::sin(rpy[0]);
  const long double cp = std::cos(rpy[1]), sp = std::sin(rpy[1]);
  const long double cy = std::cos(rpy[2]), sy = std::sin(rpy[2]);
  Matrix3l R;
  R << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return R;
}

// Reads the angles as the doubles nearest to the text, like every other number of the description;
// only what is computed from them carries more digits.
void readOrigin(const tinyxml2::XMLElement* holder, const std::string& who,
                std::map<std::string, Matrix3l>& rotations, const std::string& name) {
  const tinyxml2::XMLElement* origin = holder ? holder->FirstChildElement("origin") : nullptr;
  const char* text = origin ? origin->Attribute("rpy") : nullptr;
  if (!text) return;
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::array<long double, 3> rpy{};
  for (long double& angle : rpy) {
    double value = 0;
    if (!(stream >> value) || !std::isfinite(value)) {
      throw UrdfError(who + " " + inQuotes(name) + ": origin rpy " + inQuotes(text) +
                      " is not three finite numbers");
    }
    angle = value;
  }
  rotations[name] = rotationOf(rpy);
}

std::string nameOf(const tinyxml2::XMLElement& element) {
  const char* name = element.Attribute("name");
  return name ? name : "";
}

}  // namespace

UrdfAngles readUrdfAngles(const tinyxml2::XMLElement& robot) {
  UrdfAngles angles;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    readOrigin(link->FirstChildElement("inertial"), "link", angles.inertial_origins, nameOf(*link));
  }
  for (auto* joint = robot.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    readOrigin(joint, "joint", angles.joint_origins, nameOf(*joint));
  }
  return angles;
}

}  // namespace virtual_work_dynamics
