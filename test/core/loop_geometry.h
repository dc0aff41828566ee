#pragma once

#include "newton_euler_oracle.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Whether a closure touches in a point, or with teeth.
inline bool isTouch(const Closure& closure) {
  return closure.type == ClosureType::kRolling || closure.type == ClosureType::kKnifeEdge ||
         closure.type == ClosureType::kContact;
}
inline bool isMesh(const Closure& closure) {
  return closure.type == ClosureType::kGear || closure.type == ClosureType::kRack;
}

/// The pose of a frame on a link in the root link, in long double.
struct PlacedFrame {
  Matrix3l R;
  Vector3l o;

  PlacedFrame(const Mechanism& mechanism, const NewtonEulerOracle& bodies, const LinkFrame& frame);
};

/// The force that a spring exerts on its link_a and the points where it acts, in root axes.
struct SpringForce {
  Vector3l a, b, force_on_a;

  SpringForce(const Mechanism& mechanism, const NewtonEulerOracle& bodies,
              const PointSpring& spring);
};

}  // namespace virtual_work_dynamics
