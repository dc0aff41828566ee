#pragma once

#include <vector>

#include "loops/closure_conditions.h"

namespace virtual_work_dynamics {

/// The conditions of what touches a plane in a point: a wheel, a blade or a point. The parent's
/// frame P is the plane, z its normal. The child's frame C is that of ClosureType.
///
/// The axes of the contact stand in place of C's axes, and the point of contact in place of its
/// origin: z is the plane's normal; x of a wheel is where it rolls when it turns about its axle,
/// along axle x normal, of a blade its direction, of a point that of P; y = z x x. A condition is
/// the velocity, as P sees it, of that point of the child which touches, along a direction of these
/// axes, and its multiplier the force on the child there. A ball, a wheel whose radius is zero,
/// that slips in all directions alike has no axle: its x is that of P.
class TouchConditions : public ClosureConditions {
 public:
  TouchConditions(const Mechanism& mechanism, const Closure& closure, const Frame& parent,
                  const Frame& child, std::vector<PathStep> path, std::vector<int> coordinates);

  LinkKinematics::Displacement displacedBy(const LinkKinematics& links, const FramePair& frames,
                                           const PathStep& step, double length) const override;
  const char* fault(const LinkKinematics& links, double least) const override;

 private:
  /// See ContactNumber.
  struct Contact {
    Eigen::Matrix3d R, Rd;
    Eigen::Vector3d lever, leverd;
  };
  /// @param w how C turns as P sees it, rad/s
  Contact contactOf(const LinkKinematics& links, const Eigen::Vector3d& w) const;

  TouchShape touch_;
  bool has_normal_;
};

}  // namespace virtual_work_dynamics
