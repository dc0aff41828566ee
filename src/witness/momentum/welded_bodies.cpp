#include "witness/momentum/welded_bodies.h"

#include <Eigen/Geometry>

namespace virtual_work_dynamics {

namespace {

using Real = long double;

// Any orientation with this z axis; exact for axes along x, y or z.
Matrix3l withZ(const Vector3l& axis) {
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  Matrix3l R_KZ;
  R_KZ.col(0) = axis.cross(Vector3l::Unit(least)).normalized();
  R_KZ.col(1) = axis.cross(R_KZ.col(0));
  R_KZ.col(2) = axis;
  return R_KZ;
}

void copy(const Vector3l& v, double* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<double>(v[i]);
}

MomentumBody carriedBody(const Joint& joint, const LinkPlace& parent, const Matrix3l& R_KZ) {
  MomentumBody body;
  body.parent = parent.body;
  body.slides = joint.type == JointType::kPrismatic;
  const Matrix3l R_PZ = parent.R_ZL * joint.R_PK * R_KZ;
  for (int column = 0; column < 3; ++column) copy(R_PZ.col(column), body.R_PZ + 3 * column);
  copy(parent.p_ZoLo_Z + parent.R_ZL * joint.p_PoKo_P, body.p_PoZo_P);
  body.distance = static_cast<double>(parent.distance + joint.p_PoKo_P.norm());
  return body;
}

// Mass and moments of a body's links, added up about its origin.
struct Inertia {
  Real mass = 0;
  Vector3l h = Vector3l::Zero();
  Matrix3l G = Matrix3l::Zero();
  Real first = 0, second = 0;  // see MomentumBody
};

void add(const Link& link, const LinkPlace& place, Inertia& sum) {
  const Vector3l r_C = place.p_ZoLo_Z + place.R_ZL * link.p_KoCm_K;
  const Matrix3l& I = link.inertia_Cm_K;
  const Matrix3l G_Cm = I.trace() / 2 * Matrix3l::Identity() - I;
  sum.mass += link.mass;
  sum.h += link.mass * r_C;
  sum.G += place.R_ZL * G_Cm * place.R_ZL.transpose() + link.mass * r_C * r_C.transpose();
  const Real arm = place.distance + link.p_KoCm_K.norm();
  sum.first += link.mass * arm;
  sum.second += I.norm() + link.mass * arm * arm;
}

void finish(const Inertia& sum, MomentumBody& body) {
  const Matrix3l& G = sum.G;
  const Real entries[6] = {G(0, 0), G(0, 1), G(0, 2), G(1, 1), G(1, 2), G(2, 2)};
  for (int i = 0; i < 6; ++i) body.G[i] = static_cast<double>(entries[i]);
  copy(sum.h, body.h);
  body.mass = static_cast<double>(sum.mass);
  body.first = static_cast<double>(sum.first);
  body.second = static_cast<double>(sum.second);
  body.empty = sum.mass == 0 && G.isZero(0);
}

}  // namespace

WeldedBodies::WeldedBodies(const Mechanism& mechanism)
    : bodies(1), joints(1, -1), places(mechanism.links().size()) {
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
    const Joint& joint = mechanism.joints()[k];
    const LinkPlace& parent = places[joint.parent_link];
    if (joint.type == JointType::kFixed || joint.type == JointType::kOriented) {
      places[k + 1] = {parent.body, parent.R_ZL * joint.R_PK,
                       parent.p_ZoLo_Z + parent.R_ZL * joint.p_PoKo_P,
                       parent.distance + joint.p_PoKo_P.norm()};
      continue;
    }
    const Matrix3l R_KZ = withZ(joint.axis_K);
    // An oriented joint carries nothing but the part that follows it, with which it lines up.
    const Joint* const before =
        joint.parent_link > 0 ? &mechanism.joint(joint.parent_link - 1) : nullptr;
    if (before && before->type == JointType::kOriented) {
      oriented.push_back({bodies.size(), static_cast<std::size_t>(before->orientation),
                          parent.R_ZL.cast<double>(), (joint.R_PK * R_KZ).cast<double>()});
    }
    places[k + 1].body = static_cast<int>(bodies.size());
    places[k + 1].R_ZL = R_KZ.transpose();
    bodies.push_back(carriedBody(joint, parent, R_KZ));
    joints.push_back(static_cast<int>(k));
  }

  std::vector<Inertia> inertias(bodies.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    add(mechanism.links()[i], places[i], inertias[places[i].body]);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) finish(inertias[b], bodies[b]);
}

}  // namespace virtual_work_dynamics
