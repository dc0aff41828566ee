#pragma once

#include <string>
#include <vector>

#include "stability/random_numbers.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Where a joint is on its parent, and what it does.
struct JointPlace {
  JointType type = JointType::kRevolute;
  Vector3l axis_K = Vector3l::UnitZ();
  Matrix3l R_PK = Matrix3l::Identity();
  Vector3l p_PoKo_P = Vector3l::Zero();
};

/// Builds mechanisms joint by joint; the same seed gives the same numbers.
class MechanismMaker {
 public:
  explicit MechanismMaker(std::uint32_t seed);

  RandomNumbers& random() { return random_; }
  Vector3l direction();
  Matrix3l rotation();

  /// An axis in any direction, at the given distance from the parent's origin.
  JointPlace anyPlace(JointType type, double distance);

  /// Bodies of some length; their centres of mass are half of it away from the joint.
  Link cuboid(double mass, double length);
  /// Inertia about the centre of mass: `axial` about the given axis, `transverse` about all others.
  Link roundBody(double mass, const Vector3l& centre, const Vector3l& axis, double axial,
                 double transverse);

  /// Adds a joint with its child link, depth first, and returns the index of the link.
  int add(int parent_link, const JointPlace& place, const Link& body);
  /// Makes the joint that was added last follow a coordinate.
  void mimic(int coordinate, double multiplier, double offset);

  Mechanism mechanism(const std::string& name) const;

 private:
  RandomNumbers random_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  int coordinates_ = 0;
};

/// Revolute, but for every third, which slides.
JointType mixedType(int index);

}  // namespace virtual_work_dynamics
