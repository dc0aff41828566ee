#include "four_bar.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <utility>

namespace virtual_work_dynamics {

FourBar::FourBar(Real unit) {
  for (Real& length : lengths) length *= unit;
  const Real u2 = unit * unit;
  bodies = {{{0.7L, {0.11L * unit, 0.02L * unit, 0.03L * unit}, 0.004L * u2},
             {1.3L, {0.31L * unit, -0.07L * unit, -0.05L * unit}, 0.05L * u2},
             {0.9L, {0.22L * unit, 0.04L * unit, 0.02L * unit}, 0.02L * u2}}};
  gravity = unit * Eigen::Vector3d(1.7, -9.2, 2.9);
}

Matrix3l FourBar::planeAxes() const {
  using Turn = Eigen::AngleAxis<Real>;
  return (Turn(plane_rpy.z(), Vector3l::UnitZ()) * Turn(plane_rpy.y(), Vector3l::UnitY()) *
          Turn(plane_rpy.x(), Vector3l::UnitX()))
      .toRotationMatrix();
}

FourBar::Turnings FourBar::turnings(Real angle, Real rate, Real acceleration) const {
  const Vector2 B = lengths[0] * along(angle), D{lengths[3], 0};
  const Vector2 r = D - B;
  const Real d2 = r.squaredNorm(), l = lengths[1], s = lengths[2];
  const Real a = (d2 + l * l - s * s) / (2 * d2);
  const Real h = std::sqrt(l * l / d2 - a * a);
  const Vector2 C = B + a * r + h * Vector2(-r.y(), r.x());
  const Real coupler = std::atan2(C.y() - B.y(), C.x() - B.x());
  const Real rocker = std::atan2(C.y() - D.y(), C.x() - D.x());
  // The equation l e(coupler) - s e(rocker) = D - B is differentiated once and twice.
  Eigen::Matrix<Real, 2, 2> J;
  J << l * normal(coupler), -s * normal(rocker);
  const Vector2 rates = J.inverse() * (-lengths[0] * rate * normal(angle));
  const Vector2 right = -lengths[0] * (acceleration * normal(angle) - rate * rate * along(angle)) +
                        l * rates[0] * rates[0] * along(coupler) -
                        s * rates[1] * rates[1] * along(rocker);
  const Vector2 accelerations = J.inverse() * right;
  return {{{angle, rate, acceleration},
           {coupler, rates[0], accelerations[0]},
           {rocker, rates[1], accelerations[1]}}};
}

FourBar::Cut FourBar::cut(char pivot) const {
  using Hangings = std::vector<Cut::Hanging>;
  const Cut::Hanging A{'A', kCrank, -1}, D{'D', kRocker, -1}, down_B{'B', kCoupler, kCrank},
      up_B{'B', kCrank, kCoupler}, down_C{'C', kRocker, kCoupler}, up_C{'C', kCoupler, kRocker};
  if (pivot == 'A') return cut(Hangings{D, up_C, up_B}, {'A', kCrank, -1});
  if (pivot == 'B') return cut(Hangings{A, D, up_C}, down_B);
  if (pivot == 'C') return cut(Hangings{A, down_B, D}, down_C);
  return cut(Hangings{A, down_B, down_C}, {'D', kRocker, -1});
}

FourBar::Forces FourBar::freeBodies(const Turnings& turnings) const {
  using System = Eigen::Matrix<Real, 9, 9>;
  System equations = System::Zero();
  Eigen::Matrix<Real, 9, 1> right;
  // The unknowns are A B C D, each x y, and the torque. B and C have other signs on their other
  // bodies.
  const int first[3] = {0, 1, 3}, second[3] = {1, 2, 2};
  const Real sign_second[3] = {-1, -1, 1};
  for (std::size_t b = 0; b < 3; ++b) {
    const Turning& t = turnings[b];
    const Vector2 to_centre = turned(bodies[b].centre, t.angle);
    const Vector2 to_second = lengths[b] * along(t.angle) - to_centre;
    Vector2 a = pivotAcceleration(static_cast<int>(b), turnings);
    a += t.acceleration * Vector2(-to_centre.y(), to_centre.x()) - t.rate * t.rate * to_centre;
    const int row = static_cast<int>(3 * b);
    for (int i = 0; i < 2; ++i) {
      equations(row + i, 2 * first[b] + i) = 1;
      equations(row + i, 2 * second[b] + i) = sign_second[b];
      right[row + i] = bodies[b].mass * (a[i] - gravity[i]);
    }
    addMoment(equations, row + 2, first[b], -to_centre, 1);
    addMoment(equations, row + 2, second[b], to_second, sign_second[b]);
    right[row + 2] = bodies[b].moment * t.acceleration;
  }
  equations(2, 8) = 1;
  const Eigen::Matrix<Real, 9, 1> x = equations.fullPivLu().solve(right);
  Forces forces;
  for (int p = 0; p < 4; ++p) {
    forces.on_body['A' + static_cast<char>(p)] = Vector2(x[2 * p], x[2 * p + 1]);
  }
  forces.torque = x[8];
  return forces;
}

FourBar::Vector2 FourBar::turned(const Vector3l& v, Real angle) {
  return v.x() * along(angle) + v.y() * normal(angle);
}

FourBar::Vector2 FourBar::pivotAcceleration(int body, const Turnings& turnings) const {
  if (body != kCoupler) return Vector2::Zero();
  const Turning& crank = turnings[kCrank];
  return lengths[0] *
         (crank.acceleration * normal(crank.angle) - crank.rate * crank.rate * along(crank.angle));
}

Vector3l FourBar::place(int body, char pivot) const {
  if (body < 0) return pivot == 'D' ? Vector3l(lengths[3], 0, 0) : Vector3l::Zero();
  const bool second = pivot == 'C' || (pivot == 'B' && body == kCrank);
  return second ? Vector3l(lengths[static_cast<std::size_t>(body)], 0, 0) : Vector3l::Zero();
}

FourBar::Cut FourBar::cut(const std::vector<Cut::Hanging>& joints,
                          const Cut::Hanging& closure) const {
  static const char* const kNames[] = {"crank", "coupler", "rocker"};
  const auto nameOf = [](int body) { return body < 0 ? "base" : kNames[body]; };
  std::vector<Link> links(1);
  links[0].name = "base";
  std::vector<Joint> built;
  std::map<int, int> link_of{{-1, 0}};
  std::map<int, Vector3l> origin_of{{-1, Vector3l::Zero()}};  // origin of the link on the body
  for (const Cut::Hanging& hanging : joints) {
    const int k = static_cast<int>(built.size());
    Joint joint;
    joint.name = std::string(1, hanging.pivot);
    joint.type = JointType::kContinuous;
    joint.parent_link = link_of[hanging.parent];
    joint.child_link = k + 1;
    joint.axis_K = Vector3l::UnitZ();
    joint.coordinate = k;
    joint.p_PoKo_P = place(hanging.parent, hanging.pivot) - origin_of[hanging.parent];
    if (hanging.parent < 0) {
      joint.R_PK = planeAxes();
      joint.p_PoKo_P = joint.R_PK * joint.p_PoKo_P;
    }
    built.push_back(joint);
    const Inertia& inertia = bodies[static_cast<std::size_t>(hanging.body)];
    Link link;
    link.name = nameOf(hanging.body);
    link.parent_joint = k;
    link.mass = inertia.mass;
    link_of[hanging.body] = k + 1;
    origin_of[hanging.body] = place(hanging.body, hanging.pivot);
    link.p_KoCm_K = inertia.centre - origin_of[hanging.body];
    const Real i = inertia.moment;
    link.inertia_Cm_K << 0.7L * i, 0, 0.1L * i, 0, 0.8L * i, -0.2L * i, 0.1L * i, -0.2L * i, i;
    links.push_back(link);
  }
  Closure cut_joint;
  cut_joint.name = std::string(1, closure.pivot);
  cut_joint.type = ClosureType::kRevolute;
  cut_joint.parent.link = nameOf(closure.parent);
  cut_joint.child.link = nameOf(closure.body);
  Vector3l at = place(closure.parent, closure.pivot) - origin_of[closure.parent];
  if (closure.parent < 0) {
    at = planeAxes() * at;
    cut_joint.parent.rpy = plane_rpy;
  }
  cut_joint.parent.xyz = at.cast<double>();
  cut_joint.child.xyz =
      (place(closure.body, closure.pivot) - origin_of[closure.body]).cast<double>();
  Scene scene;
  scene.gravity = planeAxes().cast<double>() * gravity;
  scene.closures = {cut_joint};
  scene.actuated = std::vector<std::string>{"A"};
  Cut made{Mechanism("four_bar", links, built), scene, joints, closure};
  const Motion start = made.motion(turnings(0.8L, 0, 0));
  for (std::size_t k = 0; k < built.size(); ++k) {
    made.scene.assembly.push_back({built[k].name, start.q[static_cast<Eigen::Index>(k)]});
  }
  return made;
}

Motion FourBar::Cut::motion(const Turnings& turnings) const {
  Motion motion(3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Hanging& joint = joints[static_cast<std::size_t>(i)];
    Turning t = turnings[static_cast<std::size_t>(joint.body)];
    if (joint.parent >= 0) {
      const Turning& p = turnings[static_cast<std::size_t>(joint.parent)];
      t = {t.angle - p.angle, t.rate - p.rate, t.acceleration - p.acceleration};
    }
    motion.q[i] = static_cast<double>(t.angle);
    motion.qd[i] = static_cast<double>(t.rate);
    motion.qdd[i] = static_cast<double>(t.acceleration);
  }
  return motion;
}

}  // namespace virtual_work_dynamics
