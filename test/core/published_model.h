#pragma once

#include <algorithm>
#include <sstream>
#include <string>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {

/// A description with its scene, and one motion of it.
struct PublishedModel {
  PublishedModel(const std::string& urdf, const std::string& scene_text)
      : scene(readScene(YAML::Load(scene_text))),
        mechanism(withJointTypes(readUrdf("<robot name='published'>" + urdf + "</robot>"), scene)),
        dynamics(mechanism, scene),
        workspace(dynamics.makeWorkspace()),
        motion(dynamics.coordinates(), dynamics.orientations()) {
    motion.q = dynamics.assembly();
  }

  Eigen::Index coordinate(const std::string& name) const {
    const auto& names = mechanism.coordinateNames();
    return std::find(names.begin(), names.end(), name) - names.begin();
  }
  double effort(const std::string& name) const {
    const auto& names = dynamics.effortNames();
    return workspace.results().effort[std::find(names.begin(), names.end(), name) - names.begin()];
  }
  /// What the parent exerts on the child, in root axes.
  const Wrench& reaction(const std::string& name) const {
    const auto& names = dynamics.request().root_axes;
    const auto place = std::find(names.begin(), names.end(), name) - names.begin();
    return workspace.results().root_axes.at(static_cast<std::size_t>(place));
  }
  bool complete() {
    return dynamics.completeFromCloseBy(motion, dynamics.given().coordinates, workspace);
  }
  void compute() { dynamics.compute(motion, workspace); }

  Scene scene;
  Mechanism mechanism;
  Dynamics dynamics;
  Dynamics::Workspace workspace;
  Motion motion;
};

/// A link in a plane: its centre of mass on x, and its moment of inertia about z.
inline std::string planarLink(const std::string& name, double mass, double centre, double izz) {
  std::ostringstream text;
  text.precision(17);
  text << "<link name='" << name << "'>";
  if (mass > 0) {
    text << "<inertial><origin xyz='" << centre << " 0 0'/><mass value='" << mass
         << "'/><inertia ixx='" << izz << "' iyy='" << izz << "' izz='" << izz
         << "' ixy='0' ixz='0' iyz='0'/></inertial>";
  }
  text << "</link>";
  return text.str();
}

/// A joint named as its child.
inline std::string planarJoint(const std::string& type, const std::string& parent,
                               const std::string& child, const std::string& axis, double x = 0,
                               double y = 0, double yaw = 0) {
  std::ostringstream text;
  text.precision(17);
  text << "<joint name='" << child << "' type='" << type << "'><parent link='" << parent
       << "'/><child link='" << child << "'/><origin xyz='" << x << ' ' << y << " 0' rpy='0 0 "
       << yaw << "'/><axis xyz='" << axis << "'/>"
       << "<limit lower='-9' upper='9' effort='1' velocity='1'/></joint>";
  return text.str();
}

}  // namespace virtual_work_dynamics
