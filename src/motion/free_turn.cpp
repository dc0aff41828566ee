#include "virtual_work_dynamics/free_turn.h"

namespace virtual_work_dynamics {

namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// epsilon - qdd where the angles are zero.
Vector3d mixed(const Vector3d& w) {
  return {w.y() * w.z(), -w.x() * w.z(), w.x() * w.y()};
}

Quaterniond turnAbout(int axis, double angle) {
  return Quaterniond(Eigen::AngleAxisd(angle, Vector3d::Unit(axis)));
}

}  // namespace

void setFreeTurn(const Mechanism& mechanism, std::size_t orientation, const FreeTurn& turn,
                 Motion& motion) {
  const int first = mechanism.anglesOf(orientation);
  const Vector3d& w = turn.angular_velocity;
  motion.orientations[orientation] = turn.orientation;
  motion.q.segment<3>(first).setZero();
  motion.qd.segment<3>(first) = w;
  motion.qdd.segment<3>(first) = turn.angular_acceleration - mixed(w);
}

FreeTurn freeTurnOf(const Mechanism& mechanism, std::size_t orientation, const Motion& motion) {
  const int first = mechanism.anglesOf(orientation);
  FreeTurn turn;
  turn.orientation = motion.orientations[orientation];
  for (int i = 0; i < 3; ++i) {
    const Vector3d u = Vector3d::Unit(i);
    const Quaterniond own = turnAbout(i, motion.q[first + i]), back = own.conjugate();
    const double qd = motion.qd[first + i];
    turn.orientation = turn.orientation * own;
    turn.angular_velocity = back * turn.angular_velocity + qd * u;  // (2.5)
    turn.angular_acceleration = back * turn.angular_acceleration +  // (2.7)
                                qd * turn.angular_velocity.cross(u) + motion.qdd[first + i] * u;
  }
  turn.orientation.normalize();
  return turn;
}

void foldFreeTurns(const Mechanism& mechanism, Motion& motion) {
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    if (motion.q.segment<3>(mechanism.anglesOf(i)).isZero(0)) continue;
    setFreeTurn(mechanism, i, freeTurnOf(mechanism, i, motion), motion);
  }
}

}  // namespace virtual_work_dynamics
