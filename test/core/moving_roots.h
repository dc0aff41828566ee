#pragma once

#include <Eigen/Geometry>
#include <random>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// A motion of the root with velocities and accelerations of some m/s, rad/s and so on; every
/// attitude is as likely. The same generator gives the same motion.
inline RootMotion randomRootMotion(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const auto vector = [&](double size) {
    const double x = normal(generator), y = normal(generator);
    return Eigen::Vector3d(size * x, size * y, size * normal(generator));
  };
  RootMotion root;
  root.position = vector(3);
  const Eigen::Vector3d xyz = vector(1);
  root.orientation = Eigen::Quaterniond(normal(generator), xyz.x(), xyz.y(), xyz.z()).normalized();
  root.velocity = vector(2);
  root.angular_velocity = vector(2);
  root.acceleration = vector(5);
  root.angular_acceleration = vector(5);
  return root;
}

/// A mechanism whose root hangs on six joints without mass: three that slide along inertial axes,
/// then turns about z, y and x. What its root's parent exerts on it is ground's wrench.
struct CarriedMechanism {
  static constexpr int kJoints = 6;

  /// @param mechanism in depth-first order, with names that none of the six have
  explicit CarriedMechanism(const Mechanism& of) : links(kJoints), joints(kJoints) {
    static const char* const kNames[] = {"carrier_x",   "carrier_y",     "carrier_z",
                                         "carrier_yaw", "carrier_pitch", "carrier_roll"};
    for (int i = 0; i < kJoints; ++i) {
      const auto at = static_cast<std::size_t>(i);
      links[at].name = std::string(kNames[at]) + "_base";
      links[at].parent_joint = i - 1;
      Joint& joint = joints[at];
      joint.name = kNames[at];
      joint.type = i < 3 ? JointType::kPrismatic : JointType::kRevolute;
      joint.axis_K = Vector3l::Unit(i < 3 ? i : 5 - i);
      joint.parent_link = i;
      joint.child_link = i + 1;
      joint.coordinate = i;
    }
    for (Link link : of.links()) {
      link.parent_joint += kJoints;
      links.push_back(link);
    }
    for (Joint joint : of.joints()) {
      joint.parent_link += kJoints;
      joint.child_link += kJoints;
      if (joint.coordinate >= 0) joint.coordinate += kJoints;
      joints.push_back(joint);
    }
  }

  Mechanism mechanism() const { return Mechanism("carried", links, joints); }

  std::vector<Link> links;
  std::vector<Joint> joints;
};

/// A motion of a CarriedMechanism from that of its root by angles about z, y and x.
struct CarrierAngles {
  Eigen::Vector3d angles, rates, accelerations;  ///< about z, y, x

  /// The motion of the root that they make: R = Rz Ry Rx, in long double and rounded once.
  RootMotion root(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                  const Eigen::Vector3d& acceleration) const {
    using Turn = Eigen::AngleAxis<long double>;
    const Vector3l a = angles.cast<long double>(), r = rates.cast<long double>(),
                   b = accelerations.cast<long double>();
    const Vector3l z = Vector3l::UnitZ();
    const Vector3l y = Turn(a[0], z) * Vector3l::UnitY();
    const Vector3l x = Turn(a[0], z) * (Turn(a[1], Vector3l::UnitY()) * Vector3l::UnitX());
    const Vector3l w_z = r[0] * z, w_y = w_z + r[1] * y;
    RootMotion root;
    root.position = position;
    root.velocity = velocity;
    root.acceleration = acceleration;
    root.orientation =
        Eigen::Quaternion<long double>(Turn(a[0], z) * Turn(a[1], Vector3l::UnitY()) *
                                       Turn(a[2], Vector3l::UnitX()))
            .cast<double>();
    root.angular_velocity = (w_y + r[2] * x).cast<double>();
    root.angular_acceleration =
        (b[0] * z + b[1] * y + w_z.cross(r[1] * y) + b[2] * x + w_y.cross(r[2] * x)).cast<double>();
    return root;
  }
};

}  // namespace virtual_work_dynamics
