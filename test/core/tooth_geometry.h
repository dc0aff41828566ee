#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "loop_geometry.h"
#include "newton_euler_oracle.h"

namespace virtual_work_dynamics {

/// Where wheels mesh, or a wheel and a rack, by geometry alone: the pitch point, in which circles
/// or lines touch, and the directions of the force there on the child.
struct PlacedTeeth {
  PlacedTeeth(const Mechanism& mechanism, const NewtonEulerOracle& bodies, const Closure& closure) {
    const PlacedFrame parent(mechanism, bodies, closure.parent);
    const PlacedFrame child(mechanism, bodies, closure.child);
    const long double parent_radius = closure.teeth.parent_radius;
    axis = parent.R.col(2);
    Vector3l to_point;  // from the parent's axis
    if (closure.type == ClosureType::kRack) {
      const Vector3l line = child.R.col(0), r = child.o - parent.o;
      o = child.o - line.dot(r) * line;
      to_point = o - parent.o - axis.dot(o - parent.o) * axis;
      outward = to_point.normalized() * (parent_radius < 0 ? -1 : 1);
    } else {
      // The pitch point divides the line of centres as the radii do.
      const long double child_radius = closure.teeth.child_radius;
      const Vector3l r = child.o - parent.o, centres = r - axis.dot(r) * axis;
      to_point = centres * (parent_radius / (parent_radius + child_radius));
      o = parent.o + axis.dot(r) * axis + to_point;
      // Teeth on the outside of the parent press outwards, those of a ring inwards.
      outward = to_point.normalized() * (parent_radius < 0 ? -1 : 1);
    }
    tangent = axis.cross(outward);
    press = std::tan(static_cast<long double>(closure.teeth.pressure_angle)) /
            std::cos(static_cast<long double>(closure.teeth.helix_angle));
    thrust = std::tan(static_cast<long double>(closure.teeth.helix_angle));
  }

  /// The line of the force. One of its flanks bears what pushes the child along the tangent, the
  /// other the opposite; both press the wheels apart.
  Vector3l line(bool other_flank) const {
    return (tangent + thrust * axis + (other_flank ? -press : press) * outward).normalized();
  }

  Vector3l o, axis, outward, tangent;
  long double press, thrust;  // over the tangential force
};

}  // namespace virtual_work_dynamics
