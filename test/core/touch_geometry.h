#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "loop_geometry.h"
#include "newton_euler_oracle.h"

namespace virtual_work_dynamics {

/// Where a closure touches, by geometry alone: the point of contact, its axes (rolling or along the
/// blade, across, normal), and the directions in which it bears no force.
struct PlacedTouch {
  PlacedTouch(const Mechanism& mechanism, const NewtonEulerOracle& bodies, const Closure& closure) {
    const PlacedFrame plane(mechanism, bodies, closure.parent);
    const PlacedFrame child(mechanism, bodies, closure.child);
    const Touch& touch = closure.touch;
    o = child.o;
    R = plane.R;
    const Vector3l n = plane.R.col(2);
    if (closure.type == ClosureType::kRolling) {
      // The way down in the plane of the wheel, and then through the tube.
      const Vector3l axle = child.R.col(2);
      const Vector3l down = axle.cross(axle.cross(n)).normalized();
      o = child.o + touch.radius * down - touch.tube_radius * n;
      // A ball that slips in all directions alike has no axle.
      const bool alike = touch.slip == Slip::kNone || touch.slip == Slip::kAll;
      if (touch.radius > 0 || touch.roller_angle || !alike) setAxes(axle.cross(n), n);
      if (touch.radius == 0) o = child.o - touch.tube_radius * n;
    }
    if (closure.type == ClosureType::kKnifeEdge) setAxes(n.cross(child.R.col(0)).cross(n), n);
    addFree(closure);
  }

  Vector3l o;
  Matrix3l R;
  std::vector<Vector3l> free;

 private:
  void setAxes(const Vector3l& along, const Vector3l& n) {
    R.col(0) = along.normalized();
    R.col(2) = n;
    R.col(1) = n.cross(R.col(0));
  }

  void addFree(const Closure& closure) {
    const Touch& touch = closure.touch;
    if (touch.roller_angle && touch.closed) {
      const long double c = std::cos(static_cast<long double>(*touch.roller_angle));
      const long double s = std::sin(static_cast<long double>(*touch.roller_angle));
      free.push_back(c * R.col(0) + s * R.col(1));
    } else {
      const bool slips_along = touch.slip == Slip::kRolling || touch.slip == Slip::kAll ||
                               closure.type == ClosureType::kKnifeEdge;
      const bool slips_across = touch.slip == Slip::kLateral || touch.slip == Slip::kAll;
      if (slips_along || !touch.closed) free.push_back(R.col(0));
      if (slips_across || !touch.closed) free.push_back(R.col(1));
    }
    if (!touch.normal || !touch.closed) free.push_back(R.col(2));
  }
};

}  // namespace virtual_work_dynamics
