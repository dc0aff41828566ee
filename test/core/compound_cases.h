#pragma once

#include <Eigen/Core>
#include <string>

#include "random_cases.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {

/// A random tree in which some joints have several freedoms. The same seed gives the same case.
struct CompoundCase {
  explicit CompoundCase(unsigned seed, bool is_static = false)
      : random(seed),
        described(random.mechanism(2 + static_cast<int>(seed % 9))),
        scene(sceneOf(is_static)),
        mechanism(withJointTypes(described, scene)),
        motion(random.motion(mechanism)) {}

  RandomCases random;
  Mechanism described;
  Scene scene;
  Mechanism mechanism;
  Motion motion;

 private:
  Scene sceneOf(bool is_static) {
    Scene made;
    made.gravity = random.doubles(10);
    made.static_motion = is_static;
    made.include_active = random.chance(0.5);
    for (int i = 0; i < 3; ++i) scene.applied_wrenches.push_back(random.appliedWrench(described));
    for (std::size_t k = 0; k < described.joints().size(); ++k) {
      if (!mayChange(described, static_cast<int>(k)) || random.chance(0.3)) continue;
      JointTypeEntry entry;
      entry.joint = described.joints()[k].name;
      entry.type = static_cast<CompoundType>(random.pick(4));
      const bool has_axis = described.joints()[k].type != JointType::kFixed;
      if (!has_axis || random.chance(0.5)) entry.axis = axis();
      if (entry.type == CompoundType::kUniversal) entry.axis2 = axis();
      if (entry.type == CompoundType::kUniversal && !entry.axis) entry.axis = axis();
      while (entry.axis && entry.axis2 &&
             entry.axis->normalized().cross(entry.axis2->normalized()).norm() < 0.2) {
        entry.axis2 = axis();
      }
      if (entry.type == CompoundType::kScrew) entry.pitch = random.uniform(-0.5, 0.5);
      made.joint_types.push_back(entry);
    }
    return made;
  }

  // Along an axis of the frame, or oblique, of any length.
  Eigen::Vector3d axis() {
    if (random.chance(0.5)) return random.uniform(0.5, 2) * Eigen::Vector3d::Unit(random.pick(3));
    return random.doubles(1);
  }

  static bool mayChange(const Mechanism& mechanism, int k) {
    const Joint& joint = mechanism.joint(k);
    if (joint.mimics) return false;
    for (const Joint& other : mechanism.joints()) {
      if (other.mimics && other.coordinate == joint.coordinate) return false;
    }
    return true;
  }
};

}  // namespace virtual_work_dynamics
