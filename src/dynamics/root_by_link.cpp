#include "dynamics/root_by_link.h"

#include <Eigen/Geometry>

namespace virtual_work_dynamics {

void RootByLink::place(const Motion& motion, int link) {
  links_.setOrientations(motion.orientations);
  links_.setPosition(motion.q);
  links_.setVelocity(motion.qd);
  R_0L_ = Eigen::Quaterniond(links_.axesOf(link));
  p_ = links_.originOf(link);
  relative_ = links_.motionAt(link, p_);
  // What the accelerations of the joints add.
  for (int at = link; at > 0; at = mechanism_.joint(at - 1).parent_link) {
    const PathStep step{at - 1, 1};
    const int coordinate = links_.coordinateOf(step);
    if (coordinate < 0) continue;
    const LinkKinematics::Displacement by = links_.movedBy(step, p_);
    relative_.alpha += motion.qdd[coordinate] * by.turn;
    relative_.a += motion.qdd[coordinate] * by.origin;
  }
}

// What the link's vectors differ by from those of the root, in inertial axes.
struct RootByLink::Lever {
  Eigen::Vector3d position, velocity, w, epsilon;
  Eigen::Vector3d acceleration;  // without the part of the root's angular acceleration
};

RootByLink::Lever RootByLink::leverOf(const Eigen::Quaterniond& R_I0,
                                      const Eigen::Vector3d& w_0) const {
  const Eigen::Vector3d position = R_I0 * p_, v = R_I0 * relative_.v, w = R_I0 * relative_.w;
  const Eigen::Vector3d turned = w_0.cross(position);
  return {position, turned + v, w, R_I0 * relative_.alpha + w_0.cross(w),
          w_0.cross(turned) + 2 * w_0.cross(v) + R_I0 * relative_.a};
}

RootMotion RootByLink::rootOf(const RootMotion& link) const {
  RootMotion root;
  root.orientation = (link.orientation * R_0L_.conjugate()).normalized();
  root.angular_velocity = link.angular_velocity - root.orientation * relative_.w;
  const Lever lever = leverOf(root.orientation, root.angular_velocity);
  root.angular_acceleration = link.angular_acceleration - lever.epsilon;
  root.position = link.position - lever.position;
  root.velocity = link.velocity - lever.velocity;
  root.acceleration =
      link.acceleration - lever.acceleration - root.angular_acceleration.cross(lever.position);
  return root;
}

RootMotion RootByLink::linkOf(const RootMotion& root) const {
  const Lever lever = leverOf(root.orientation, root.angular_velocity);
  RootMotion link;
  link.orientation = (root.orientation * R_0L_).normalized();
  link.angular_velocity = root.angular_velocity + lever.w;
  link.angular_acceleration = root.angular_acceleration + lever.epsilon;
  link.position = root.position + lever.position;
  link.velocity = root.velocity + lever.velocity;
  link.acceleration =
      root.acceleration + lever.acceleration + root.angular_acceleration.cross(lever.position);
  return link;
}

}  // namespace virtual_work_dynamics
