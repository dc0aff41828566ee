#pragma once

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <string>

#include "random_cases.h"
#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {

/// A random tree in which some joints have several freedoms. The same seed gives the same case.
struct CompoundCase {
  explicit CompoundCase(unsigned seed, bool is_static = false)
      : random(seed),
        described(random.mechanism(2 + static_cast<int>(seed % 9))),
        scene(sceneOf(is_static)),
        mechanism(withJointTypes(described, scene)),
        motion(random.motion(mechanism)) {
    motion.orientations.resize(mechanism.orientations());
    for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
      FreeTurn turn;
      turn.orientation = attitude();
      turn.angular_velocity = random.doubles(4);
      turn.angular_acceleration = random.doubles(10);
      setFreeTurn(mechanism, i, turn, motion);
      turns[mechanism.freeJoint(i).name] = turn;
    }
  }

  RandomCases random;
  Mechanism described;
  Scene scene;
  Mechanism mechanism;
  Motion motion;
  std::map<std::string, FreeTurn> turns;  ///< of joints that turn freely, by name

 private:
  // Any, or one in which successive turns about x, y and z are singular.
  Eigen::Quaterniond attitude() {
    if (random.chance(0.2)) return Eigen::Quaterniond(std::sqrt(0.5), 0, std::sqrt(0.5), 0);
    const Eigen::Vector3d v = random.doubles(1);
    return Eigen::Quaterniond(random.uniform(-1, 1), v.x(), v.y(), v.z()).normalized();
  }

  Scene sceneOf(bool is_static) {
    Scene made;
    made.gravity = random.doubles(10);
    made.static_motion = is_static;
    made.include_active = random.chance(0.5);
    for (int i = 0; i < 3; ++i) made.applied_wrenches.push_back(random.appliedWrench(described));
    for (std::size_t k = 0; k < described.joints().size(); ++k) {
      if (!mayChange(described, static_cast<int>(k)) || random.chance(0.3)) continue;
      made.joint_types.push_back(entryOf(described.joints()[k]));
    }
    return made;
  }

  JointTypeEntry entryOf(const Joint& joint) {
    JointTypeEntry entry;
    entry.joint = joint.name;
    entry.type = static_cast<CompoundType>(random.pick(6));
    if (entry.type == CompoundType::kSpherical || entry.type == CompoundType::kFloating) {
      return entry;
    }
    if (joint.type == JointType::kFixed || random.chance(0.5)) entry.axis = axis();
    if (entry.type == CompoundType::kUniversal) entry.axis2 = axis();
    if (entry.type == CompoundType::kUniversal && !entry.axis) entry.axis = axis();
    while (entry.axis && entry.axis2 &&
           entry.axis->normalized().cross(entry.axis2->normalized()).norm() < 0.2) {
      entry.axis2 = axis();
    }
    if (entry.type == CompoundType::kScrew) entry.pitch = random.uniform(-0.5, 0.5);
    return entry;
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
