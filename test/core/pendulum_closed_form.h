#pragma once

#include <Eigen/Core>
#include <cmath>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

// The paper's composed pendulum in closed form; its description is pendulumUrdf().

inline Scene pendulumScene() {
  Scene scene;
  scene.gravity = {9.81, 0, 0};
  return scene;
}

/// The motion (5.11) of the paper.
inline Motion pendulumMotion(double t) {
  const double w = M_PI / 6;
  Motion motion(2);
  const Eigen::Vector2d amplitude(M_PI / 12, M_PI / 6);
  motion.q = amplitude * (1 - std::cos(w * t));
  motion.qd = amplitude * w * std::sin(w * t);
  motion.qdd = amplitude * w * w * std::cos(w * t);
  return motion;
}

struct Pendulum {
  double l1 = 0.5, l2 = 0.75, m1 = 0.25, m2 = 1, g = 9.81;
};

/// The efforts by (5.7), N m.
inline Eigen::Vector2d equation57(const Motion& x, const Pendulum& p) {
  const double f1 = x.q[0], f2 = x.q[1], d1 = x.qd[0], d2 = x.qd[1], e1 = x.qdd[0], e2 = x.qdd[1];
  const double M1 = (p.m1 / 3 + p.m2) * p.l1 * p.l1 * e1 + p.m2 * p.l2 * p.l2 * (e1 + e2) / 3 +
                    p.m2 * p.l1 * p.l2 * (2 * e1 + e2) * std::cos(f2) / 2 -
                    p.m2 * p.l1 * p.l2 * d2 * (2 * d1 + d2) * std::sin(f2) / 2 +
                    (p.m1 + 2 * p.m2) * p.g * p.l1 * std::sin(f1) / 2 +
                    p.m2 * p.g * p.l2 * std::sin(f1 + f2) / 2;
  const double M2 = p.m2 * p.l2 * p.l2 * (e1 + e2) / 3 +
                    p.m2 * p.l1 * p.l2 * (e1 * std::cos(f2) + d1 * d1 * std::sin(f2)) / 2 +
                    p.m2 * p.g * p.l2 * std::sin(f1 + f2) / 2;
  return {M1, M2};
}

/// The force on the first rod along +x0, downwards, by (5.8), N.
inline double equation58(const Motion& x, const Pendulum& p) {
  const double f1 = x.q[0], f = f1 + x.q[1], d1 = x.qd[0], d = d1 + x.qd[1], e1 = x.qdd[0],
               e = e1 + x.qdd[1];
  return -(p.m1 + p.m2) * p.g -
         (p.m1 + 2 * p.m2) * p.l1 * (e1 * std::sin(f1) + d1 * d1 * std::cos(f1)) / 2 -
         p.m2 * p.l2 * (e * std::sin(f) + d * d * std::cos(f)) / 2;
}

}  // namespace virtual_work_dynamics
