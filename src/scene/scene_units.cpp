#include "scene/scene_units.h"

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLargestGravity = 3000;  // m/s^2, of a centrifuge of 300 g; in mm/s^2 it is 9810
constexpr double kHeavyPayload = 50;      // times the mass of the robot, which a jack may lift
constexpr double kDegrees = 10;           // rad, of no angle between two frames

std::string listText(const Eigen::Vector3d& vector) {
  return "[" + numberText(vector.x()) + ", " + numberText(vector.y()) + ", " +
         numberText(vector.z()) + "]";
}

}  // namespace

std::vector<std::string> sceneUnitDoubts(const Mechanism& mechanism, const Scene& scene) {
  std::vector<std::string> doubts;
  if (scene.gravity.norm() > kLargestGravity) {
    doubts.push_back("gravity: " + listText(scene.gravity) + " m/s^2: is it in mm/s^2?");
  }
  for (const Closure& closure : scene.closures) {
    for (const auto& [side, rpy] : {std::make_pair("parent", closure.parent.rpy),
                                    std::make_pair("child", closure.child.rpy)}) {
      if (rpy.lpNorm<Eigen::Infinity>() < kDegrees) continue;
      doubts.push_back("closures: " + inQuotes(closure.name) + ": rpy of its " + side + " " +
                       listText(rpy) + " rad: are they degrees?");
    }
  }
  long double mass = 0;
  for (const Link& link : mechanism.links()) mass += link.mass;
  for (const Payload& payload : scene.payloads) {
    if (mass == 0 || payload.mass <= kHeavyPayload * static_cast<double>(mass)) continue;
    doubts.push_back("payload: " + numberText(payload.mass) + " kg on link " +
                     inQuotes(payload.link) + " of a robot of " +
                     numberText(static_cast<double>(mass)) + " kg: is it in g?");
  }
  return doubts;
}

}  // namespace virtual_work_dynamics
