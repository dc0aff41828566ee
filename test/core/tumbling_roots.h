#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "moving_roots.h"

namespace virtual_work_dynamics {

/// A root that sways on a Lissajous figure and turns about z, y and x by angles that pass through
/// every attitude, those of gimbal lock among them; in closed form, of matrices and without a
/// quaternion's rates.
struct TumblingRoot {
  Eigen::Vector3d start{0.4, 0.2, -0.3};  ///< angles about z, y, x at first, rad
  double speed = 1;                       ///< of everything

  RootMotion at(double t) const {
    const double w = speed;
    CarrierAngles turn;
    turn.angles = start + Eigen::Vector3d(0.7 * w * t, 1.1 * w * t + 0.3 * std::sin(2 * w * t),
                                          0.8 * std::sin(1.7 * w * t));
    turn.rates << 0.7 * w, 1.1 * w + 0.6 * w * std::cos(2 * w * t),
        1.36 * w * std::cos(1.7 * w * t);
    turn.accelerations << 0, -1.2 * w * w * std::sin(2 * w * t),
        -2.312 * w * w * std::sin(1.7 * w * t);
    const Eigen::Vector3d amplitude(0.5, -0.3, 0.2), rate = w * Eigen::Vector3d(1.9, 2.3, 3.1);
    Eigen::Vector3d position, velocity, acceleration;
    for (int i = 0; i < 3; ++i) {
      position[i] = amplitude[i] * std::sin(rate[i] * t + i);
      velocity[i] = amplitude[i] * rate[i] * std::cos(rate[i] * t + i);
      acceleration[i] = -amplitude[i] * rate[i] * rate[i] * std::sin(rate[i] * t + i);
    }
    return turn.root(position, velocity, acceleration);
  }
};

/// By how much two attitudes differ, rad.
inline double angleBetween(const RootMotion& one, const RootMotion& other) {
  return 2 * (one.orientation.conjugate() * other.orientation).vec().norm();
}

}  // namespace virtual_work_dynamics
