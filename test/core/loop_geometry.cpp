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
  const auto point = [&](const std::string& name, const Eigen::Vector3d& at) {
    const int link = mechanism.linkIndex(name);
    return Vector3l(bodies.origin(link) + bodies.orientation(link) * at.cast<long double>());
  };
  a = point(spring.link_a, spring.at_a);
  b = point(spring.link_b, spring.at_b);
  const Vector3l r = b - a;
  force_on_a = spring.stiffness * (r.norm() - spring.rest_length) * r.normalized();
}

}  // namespace virtual_work_dynamics
