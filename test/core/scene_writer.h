#pragma once

#include <string>

#include "base/number_text.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

inline std::string yamlVector(const Eigen::Vector3d& v) {
  return "[" + numberText(v[0]) + ", " + numberText(v[1]) + ", " + numberText(v[2]) + "]";
}

inline std::string yamlReactions(const Scene& scene) {
  if (scene.reactions == ReactionSelection::kAll) return "all";
  if (scene.reactions == ReactionSelection::kNone) return "none";
  std::string names;
  for (const std::string& name : scene.reaction_names) names += (names.empty() ? "" : ", ") + name;
  return "[" + names + "]";
}

inline std::string yamlJointTerms(const JointTerms& terms) {
  std::string text = "{name: " + terms.joint + ", stiffness: " + numberText(terms.stiffness) +
                     ", rest: " + numberText(terms.rest) +
                     ", rotor_inertia: " + numberText(terms.rotor_inertia) +
                     ", coulomb_velocity: " + numberText(terms.coulomb_velocity) +
                     ", offset: " + numberText(terms.offset);
  if (terms.damping) text += ", damping: " + numberText(*terms.damping);
  if (terms.coulomb) text += ", coulomb: " + numberText(*terms.coulomb);
  return text + "}";
}

/// Writes a scene as YAML from which readScene() makes the same scene.
inline std::string yamlText(const Scene& scene) {
  std::string text = "gravity: " + yamlVector(scene.gravity) +
                     "\nmotion: " + (scene.static_motion ? "static" : "full") +
                     "\nreactions: " + yamlReactions(scene) +
                     "\ninclude_active: " + (scene.include_active ? "true" : "false") +
                     "\nstrict_inertia: " + (scene.strict_inertia ? "true" : "false") + "\n";
  if (!scene.applied_wrenches.empty()) text += "applied_wrenches:\n";
  for (const AppliedWrench& applied : scene.applied_wrenches) {
    text += "  - {link: " + applied.link + ", at: " + yamlVector(applied.at) +
            ", axes: " + (applied.axes == Axes::kLink ? "link" : "root") +
            ", force: " + yamlVector(applied.force) + ", torque: " + yamlVector(applied.torque) +
            "}\n";
  }
  if (!scene.joints.empty()) text += "joints:\n";
  for (const JointTerms& terms : scene.joints) text += "  - " + yamlJointTerms(terms) + "\n";
  if (scene.use_urdf_dynamics) text += "use_urdf_dynamics: true\n";
  return text;
}

/// Writes a motion of one sample as CSV for the offline tool.
inline std::string csvText(const Mechanism& mechanism, const Motion& motion) {
  std::string header = "time", values = "0";
  for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
    const std::string& name = mechanism.coordinateNames()[i];
    const Eigen::Index c = static_cast<Eigen::Index>(i);
    header += ",position." + name + ",velocity." + name + ",acceleration." + name;
    values += "," + numberText(motion.q[c]) + "," + numberText(motion.qd[c]) + "," +
              numberText(motion.qdd[c]);
  }
  return header + "\n" + values + "\n";
}

}  // namespace virtual_work_dynamics
