#include "loop_geometry.h"

#include <Eigen/Geometry>

namespace virtual_work_dynamics {

PlacedFrame::PlacedFrame(const Mechanism& mechanism, const NewtonEulerOracle& bodies,
                         const LinkFrame& frame) {
  using Turn = Eigen::AngleAxis<long double>;
  const int link = mechanism.linkIndex(frame.link);
  const Matrix3l R_LF =
      (Turn(frame.rpy.z(), Vector3l::UnitZ()) * Turn(frame.rpy.y(), Vector3l::UnitY()) *
       Turn(frame.rpy.x(), Vector3l::UnitX()))
          .toRotationMatrix();
  R = bodies.orientation(link) * R_LF;
  o = bodies.origin(link) + bodies.orientation(link) * frame.xyz.cast<long double>();
}

SpringForce::SpringForce(const Mechanism& mechanism, const NewtonEulerOracle& bodies,
                         const PointSpring& spring) {
  const auto end = [&](const std::string& name, const Eigen::Vector3d& at, Vector3l& point) {
    const int link = mechanism.linkIndex(name);
    const Vector3l r = bodies.orientation(link) * at.cast<long double>();
    point = bodies.origin(link) + r;
    return Vector3l(bodies.originVelocity(link) + bodies.angularVelocity(link).cross(r));
  };
  const Vector3l v_a = end(spring.link_a, spring.at_a, a), v_b = end(spring.link_b, spring.at_b, b);
  const Vector3l r = b - a, along = r.normalized();
  const long double longer = r.norm() - spring.rest_length, faster = along.dot(v_b - v_a);
  force_on_a = (spring.stiffness * longer + spring.damping * faster) * along;
}

}  // namespace virtual_work_dynamics
