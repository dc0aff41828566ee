#pragma once

#include <Eigen/Core>
#include <cmath>
#include <unsupported/Eigen/AutoDiff>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// A number and its rate of change.
using Rated = Eigen::AutoDiffScalar<Eigen::Matrix<long double, 1, 1>>;

template <typename S>
using V3 = Eigen::Matrix<S, 3, 1>;
template <typename S>
using M3 = Eigen::Matrix<S, 3, 3>;

template <typename S>
V3<S> crossed(const V3<S>& a, const V3<S>& b) {
  return V3<S>(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

template <typename S>
V3<S> constant(const Vector3l& v) {
  return V3<S>(S(v[0]), S(v[1]), S(v[2]));
}

template <typename S>
M3<S> constant(const Matrix3l& A) {
  M3<S> result;
  for (int i = 0; i < 9; ++i) result(i / 3, i % 3) = S(A(i / 3, i % 3));
  return result;
}

// The rotation about a unit vector by Rodrigues' formula.
template <typename S>
M3<S> rotationAbout(const Vector3l& u, const S& angle) {
  using std::cos;
  using std::sin;
  const S c = cos(angle), s = sin(angle);
  M3<S> R;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const long double skew = i == j ? 0 : ((j - i + 3) % 3 == 1 ? -u[3 - i - j] : u[3 - i - j]);
      R(i, j) = S(u[i] * u[j]) + c * S((i == j) - u[i] * u[j]) + s * S(skew);
    }
  }
  return R;
}

/// The motion of a link's frame in root axes.
template <typename S>
struct LinkMotion {
  M3<S> R = constant<S>(Matrix3l(Matrix3l::Identity()));  // link -> root axes
  V3<S> o = constant<S>(Vector3l(Vector3l::Zero()));      // place of the origin
  V3<S> v = o;
  V3<S> w = o;
};

/// The motions of all links, from positions and velocities alone. With numbers that carry their
/// rates of change (Rated), they contain accelerations for which no formula was written.
template <typename S>
std::vector<LinkMotion<S>> linkMotions(const Mechanism& mechanism, const std::vector<S>& q,
                                       const std::vector<S>& qd) {
  std::vector<LinkMotion<S>> links(mechanism.links().size());
  for (const Joint& joint : mechanism.joints()) {
    const LinkMotion<S>& parent = links[joint.parent_link];
    LinkMotion<S>& link = links[joint.child_link];
    const M3<S> R_joint = parent.R * constant<S>(joint.R_PK);
    const V3<S> axis = R_joint * constant<S>(joint.axis_K);
    S position(0), rate(0);
    if (joint.coordinate >= 0) {
      position = q[joint.coordinate] * S(joint.multiplier) + S(joint.offset);
      rate = qd[joint.coordinate] * S(joint.multiplier);
    }
    V3<S> r = parent.R * constant<S>(joint.p_PoKo_P);
    link.R = R_joint;
    link.w = parent.w;
    V3<S> slide = constant<S>(Vector3l(Vector3l::Zero()));
    if (joint.type == JointType::kPrismatic) {
      r += axis * position;
      slide = axis * rate;
    } else if (joint.coordinate >= 0) {
      link.R = R_joint * rotationAbout<S>(joint.axis_K, position);
      link.w = parent.w + axis * rate;
    }
    link.o = parent.o + r;
    link.v = parent.v + crossed<S>(parent.w, r) + slide;
  }
  return links;
}

/// The motions of all links with their rates of change along a motion: q changes at qd, and qd at
/// qdd.
inline std::vector<LinkMotion<Rated>> linkMotions(const Mechanism& mechanism,
                                                  const Motion& motion) {
  std::vector<Rated> q, qd;
  for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
    q.emplace_back(motion.q[i], Eigen::Matrix<long double, 1, 1>(motion.qd[i]));
    qd.emplace_back(motion.qd[i], Eigen::Matrix<long double, 1, 1>(motion.qdd[i]));
  }
  return linkMotions<Rated>(mechanism, q, qd);
}

inline Vector3l rateOf(const V3<Rated>& v) {
  Vector3l rate;
  for (int i = 0; i < 3; ++i) rate[i] = v[i].derivatives()[0];
  return rate;
}

inline Vector3l valueOf(const V3<Rated>& v) {
  return {v[0].value(), v[1].value(), v[2].value()};
}

}  // namespace virtual_work_dynamics
