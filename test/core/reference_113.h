#pragma once

#include <cfloat>
#include <cmath>
#include <vector>

// Real113 is a number of 113 bits, in which the long double constants of a Mechanism are exact.
// Where the compiler has no such type, VWD_HAS_REAL113 stays undefined.
#if LDBL_MANT_DIG == 113
#define VWD_HAS_REAL113
namespace virtual_work_dynamics {
using Real113 = long double;
inline Real113 sine(Real113 x) {
  return std::sin(x);
}
inline Real113 cosine(Real113 x) {
  return std::cos(x);
}
inline Real113 root(Real113 x) {
  return std::sqrt(x);
}
inline Real113 magnitude(Real113 x) {
  return std::fabs(x);
}
inline bool isFinite(Real113 x) {
  return std::isfinite(x);
}
}  // namespace virtual_work_dynamics
#elif defined(__SIZEOF_FLOAT128__) && __has_include(<quadmath.h>)
#define VWD_HAS_REAL113
#include <quadmath.h>
namespace virtual_work_dynamics {
using Real113 = __float128;
inline Real113 sine(Real113 x) {
  return sinq(x);
}
inline Real113 cosine(Real113 x) {
  return cosq(x);
}
inline Real113 root(Real113 x) {
  return sqrtq(x);
}
inline Real113 magnitude(Real113 x) {
  return fabsq(x);
}
inline bool isFinite(Real113 x) {
  return finiteq(x);
}
}  // namespace virtual_work_dynamics
#endif

#ifdef VWD_HAS_REAL113

#include "scene/joint_terms.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

struct Vector113 {
  Real113 x = 0, y = 0, z = 0;
};

inline Vector113 operator+(const Vector113& a, const Vector113& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector113 operator-(const Vector113& a, const Vector113& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector113 operator*(Real113 s, const Vector113& v) {
  return {s * v.x, s * v.y, s * v.z};
}
inline Real113 dot(const Vector113& a, const Vector113& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Real113 norm(const Vector113& v) {
  return root(dot(v, v));
}
inline Vector113 cross(const Vector113& a, const Vector113& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename Vector>
Vector113 toVector113(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}

/// A matrix by its columns.
struct Matrix113 {
  Vector113 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

inline Vector113 operator*(const Matrix113& A, const Vector113& v) {
  return v.x * A.x + v.y * A.y + v.z * A.z;
}
inline Vector113 transposed(const Matrix113& A, const Vector113& v) {
  return {dot(A.x, v), dot(A.y, v), dot(A.z, v)};
}
inline Matrix113 operator*(const Matrix113& A, const Matrix113& B) {
  return {A * B.x, A * B.y, A * B.z};
}
inline Matrix113 toMatrix113(const Matrix3l& A) {
  return {toVector113(A.col(0)), toVector113(A.col(1)), toVector113(A.col(2))};
}

/// Inverse dynamics by Newton's and Euler's equations in 113 bits, the yardstick of the errors.
/// Every link is computed by itself, with fixed joints kept, accelerations and forces in root axes,
/// about centres of mass. Shares only the Mechanism with the package's recursion.
class Reference113 {
 public:
  struct Wrench {
    Vector113 force, torque;
  };

  Reference113(const Mechanism& mechanism, const Scene& scene, const Motion& motion)
      : mechanism_(mechanism), links_(mechanism.links().size()) {
    const int joints = static_cast<int>(mechanism.joints().size());
    for (int k = 0; k < joints; ++k) moveLink(k, motion, scene.static_motion);
    for (int i = 0; i <= joints; ++i) balanceLink(i, toVector113(scene.gravity));
    for (const AppliedWrench& applied : scene.applied_wrenches) subtract(applied);
    for (int k = joints - 1; k >= 0; --k) addToParent(k);
    actuators_.assign(mechanism.coordinates().size(), 0);
    for (const ResolvedJointTerms& terms : resolveJointTerms(mechanism, scene)) {
      addActuator(terms, motion, scene.static_motion);
    }
  }

  /// Effort of every generalized coordinate, mimic joints and joint terms included, N m or N.
  std::vector<Real113> efforts() const {
    std::vector<Real113> efforts = actuators_;
    for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
      const Joint& joint = mechanism_.joints()[k];
      if (joint.coordinate < 0) continue;
      const Wrench wrench = childAxes(static_cast<int>(k));
      const bool slides = joint.type == JointType::kPrismatic;
      efforts[joint.coordinate] +=
          joint.multiplier * dot(toVector113(joint.axis_K), slides ? wrench.force : wrench.torque);
    }
    return efforts;
  }

  /// Wrench of the parent on the child about the joint origin, in axes of the child link; joint -1
  /// means that of ground on the root link.
  Wrench childAxes(int joint) const {
    const LinkState& link = links_[joint + 1];
    return {transposed(link.R, link.force), transposed(link.R, link.torque)};
  }

  /// Wrench of the parent on the child about the joint origin, in root axes; joint -1 means that of
  /// ground on the root link.
  Wrench rootAxes(int joint) const { return {links_[joint + 1].force, links_[joint + 1].torque}; }

 private:
  struct LinkState {
    Matrix113 R;              // link -> root axes
    Vector113 r;              // from the parent's origin to this one
    Vector113 a;              // acceleration of the origin
    Vector113 w, alpha;       // angular velocity and acceleration
    Vector113 force, torque;  // wrench on the link with all that it carries, about the origin
  };

  // The rotation by Rodrigues' formula; `axis` is a unit vector.
  static Matrix113 rotation(const Vector113& axis, Real113 angle) {
    const Real113 s = sine(angle), c = cosine(angle);
    const auto turned = [&](const Vector113& v) {
      return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
    };
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
  }

  void moveLink(int k, const Motion& motion, bool rests) {
    const Joint& joint = mechanism_.joints()[k];
    const LinkState& parent = links_[joint.parent_link];
    LinkState& link = links_[k + 1];
    const int c = joint.coordinate;
    const Real113 multiplier = joint.multiplier;
    const Real113 q = c < 0 ? Real113(0) : multiplier * motion.q[c] + joint.offset;
    const Real113 qd = c < 0 || rests ? Real113(0) : multiplier * motion.qd[c];
    const Real113 qdd = c < 0 || rests ? Real113(0) : multiplier * motion.qdd[c];

    const Matrix113 R_joint = parent.R * toMatrix113(joint.R_PK);
    const Vector113 axis = R_joint * toVector113(joint.axis_K);
    const bool slides = joint.type == JointType::kPrismatic;
    Vector113 r = parent.R * toVector113(joint.p_PoKo_P);
    if (slides) r = r + q * axis;
    link.R = R_joint;
    link.r = r;
    link.w = parent.w;
    link.alpha = parent.alpha;
    link.a = parent.a + cross(parent.alpha, r) + cross(parent.w, cross(parent.w, r));
    if (slides) {
      link.a = link.a + qdd * axis + 2 * qd * cross(parent.w, axis);
    } else if (c >= 0) {
      link.R = R_joint * rotation(toVector113(joint.axis_K), q);
      link.w = parent.w + qd * axis;
      link.alpha = parent.alpha + qdd * axis + qd * cross(parent.w, axis);
    }
  }

  // Newton's and Euler's equations about the centre of mass, with the moment taken to the link's
  // origin.
  void balanceLink(int i, const Vector113& gravity) {
    const Link& body = mechanism_.links()[i];
    LinkState& link = links_[i];
    const Vector113 r = link.R * toVector113(body.p_KoCm_K);
    const Vector113 a_cm = link.a + cross(link.alpha, r) + cross(link.w, cross(link.w, r));
    const Matrix113 I = toMatrix113(body.inertia_Cm_K);
    const Vector113 w_K = transposed(link.R, link.w);
    const Vector113 alpha_K = transposed(link.R, link.alpha);
    link.force = Real113(body.mass) * (a_cm - gravity);
    link.torque = link.R * (I * alpha_K + cross(w_K, I * w_K)) + cross(r, link.force);
  }

  void subtract(const AppliedWrench& applied) {
    LinkState& link = links_[mechanism_.linkIndex(applied.link)];
    const Matrix113 R = applied.axes == Axes::kLink ? link.R : Matrix113();
    const Vector113 force = R * toVector113(applied.force);
    const Vector113 moment =
        R * toVector113(applied.torque) + cross(link.R * toVector113(applied.at), force);
    link.force = link.force - force;
    link.torque = link.torque - moment;
  }

  void addActuator(const ResolvedJointTerms& terms, const Motion& motion, bool rests) {
    const Joint& joint = mechanism_.joints()[terms.joint];
    const int c = joint.coordinate;
    const Real113 multiplier = joint.multiplier;
    const Real113 rate = rests ? Real113(0) : multiplier * motion.qd[c];
    const Real113 acceleration = rests ? Real113(0) : multiplier * motion.qdd[c];
    Real113 s = rate / terms.coulomb_velocity;
    if (magnitude(s) > 1) s = s > 0 ? 1 : -1;
    const Real113 sum =
        terms.stiffness * (multiplier * motion.q[c] + joint.offset - Real113(terms.rest)) +
        terms.damping * rate + terms.coulomb * s * (3 - s * s) / 2 +
        terms.rotor_inertia * acceleration + terms.offset;
    actuators_[c] += multiplier * sum;
  }

  void addToParent(int k) {
    const LinkState& link = links_[k + 1];
    LinkState& parent = links_[mechanism_.joints()[k].parent_link];
    parent.force = parent.force + link.force;
    parent.torque = parent.torque + link.torque + cross(link.r, link.force);
  }

  const Mechanism& mechanism_;
  std::vector<LinkState> links_;
  std::vector<Real113> actuators_;  // part of each coordinate's effort
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
