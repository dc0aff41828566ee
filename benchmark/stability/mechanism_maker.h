#pragma once

#include <string>
#include <vector>

#include "stability/random_numbers.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// A joint's type and its place on the parent link.
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

  /// A place with an axis in any direction, at the given distance from the parent's origin.
  JointPlace anyPlace(JointType type, double distance);

  /// A cuboid whose centre of mass is half its length away from the joint.
  Link cuboid(double mass, double length);
  /// A body whose inertia about the centre of mass is `axial` about the given axis and `transverse`
  /// about axes normal to it.
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

/// The type of a joint in a row: revolute, except for every third, which slides.
JointType mixedType(int index);

}  // namespace virtual_work_dynamics
