#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

class Mechanism;

/// Axes in which a vector is given.
enum class Axes { kLink, kRoot };

/// A wrench that acts on a link from outside; (3.6) without the weight.
struct AppliedWrench {
  std::string link;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();      ///< point of action, link frame, m
  Axes axes = Axes::kLink;                           ///< of force and torque
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< about `at`, N m
};

/// What acts between a joint's actuator and the mechanism. It is part of the effort that the
/// actuator must deliver and of no reaction. All are at least zero.
struct JointTerms {
  std::string joint;              ///< a joint that moves; mimic joints have terms of their own
  double stiffness = 0;           ///< of a spring, N m/rad or N/m
  double rest = 0;                ///< position at which the spring is relaxed, rad or m
  std::optional<double> damping;  ///< viscous, N m s/rad or N s/m; not given: see use_urdf_dynamics
  std::optional<double> coulomb;  ///< dry friction, N m or N; not given: see use_urdf_dynamics
  /// Where dry friction is fully there: it is coulomb * s (3 - s^2) / 2 with s = qd /
  /// coulomb_velocity held within [-1, 1], which passes zero smoothly. At least 1e-12 rad/s or m/s.
  double coulomb_velocity = 1e-3;
  double rotor_inertia = 0;  ///< reflected to the joint: gear ratio squared included, kg m^2 or kg
};

/// Which reactions a scene asks for.
enum class ReactionSelection {
  kAll,  ///< every movable joint, mimic joints included
  kNone,
  kNamed  ///< the joints in Scene::reaction_names; fixed joints and "ground" only this way
};

/// What a user wants of a mechanism; names are resolved when it is compiled (InverseDynamics).
struct Scene {
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2, axes of the root link
  bool static_motion = false;            ///< velocities and accelerations are taken as zero
  ReactionSelection reactions = ReactionSelection::kAll;
  std::vector<std::string> reaction_names;
  /// false: the component of a reaction along the joint axis is reported as zero.
  bool include_active = true;
  bool strict_inertia = false;  ///< impossible inertias are an error rather than a doubt
  std::vector<AppliedWrench> applied_wrenches;
  std::vector<JointTerms> joints;  ///< for some joints, each once
  /// Damping and friction of the description count for joints whose terms do not give them.
  bool use_urdf_dynamics = false;
};

/// Names of the reactions that the scene asks for: "ground" first, then depth-first order.
/// @throws SceneError for a name that is no joint, or that is given twice.
std::vector<std::string> requestedReactions(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
