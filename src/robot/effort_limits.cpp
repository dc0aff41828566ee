#include "robot/effort_limits.h"

#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "robot/urdf_xml.h"

namespace virtual_work_dynamics {

std::vector<double> effortLimits(const std::string& urdf, const Mechanism& mechanism) {
  std::vector<double> limits(mechanism.coordinates().size(),
                             std::numeric_limits<double>::infinity());
  tinyxml2::XMLDocument document;
  const tinyxml2::XMLElement& robot = parseUrdfXml(urdf, document);
  for (const auto* joint = robot.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const tinyxml2::XMLElement* limit = joint->FirstChildElement("limit");
    const int coordinate = mechanism.coordinateIndex(attributeOf(*joint, "name"));
    double effort = 0;
    if (!limit || coordinate < 0 || !parseNumber(attributeOf(*limit, "effort"), effort)) continue;
    if (effort > 0) limits[static_cast<std::size_t>(coordinate)] = effort;
  }
  return limits;
}

}  // namespace virtual_work_dynamics
