#include "core/plan.h"

#include <algorithm>
#include <cmath>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

using Real = long double;

// Orientation of a frame whose z axis is `axis`: columns are its axes in K. A signed permutation
// for axes along +-x, +-y, +-z, so that those stay exact.
Matrix3l alignZ(const Vector3l& axis) {
  Matrix3l R_KZ;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) != 1) continue;
    R_KZ.col(0) = Vector3l::Unit((i + 1) % 3);
    R_KZ.col(1) = axis[i] * Vector3l::Unit((i + 2) % 3);
    R_KZ.col(2) = axis[i] * Vector3l::Unit(i);
    return R_KZ;
  }
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  R_KZ.col(0) = Vector3l::Unit(least).cross(axis).normalized();
  R_KZ.col(1) = axis.cross(R_KZ.col(0));
  R_KZ.col(2) = axis;
  return R_KZ;
}

Vec3<Real> plain(const Vector3l& v) {
  return {v.x(), v.y(), v.z()};
}

Mat3<Real> plain(const Matrix3l& A) {
  return {A(0, 0), A(0, 1), A(0, 2), A(1, 0), A(1, 1), A(1, 2), A(2, 0), A(2, 1), A(2, 2)};
}

// Where a link of the description ended up.
struct Placement {
  int body = 0;
  Matrix3l R_ZL = Matrix3l::Identity();
  Vector3l p_ZoLo_Z = Vector3l::Zero();
};

class Compiler {
 public:
  Compiler(const Mechanism& mechanism, const Scene& scene, const Request& request)
      : mechanism_(mechanism), scene_(scene), request_(request) {}

  Plan<Real> compile() {
    checkInertias();
    resolveReactions();
    makeBodies();
    addInertias();
    markNeeds();
    addOutputs();
    addApplied();
    dropBodiesWithoutUse();
    plan_.coordinates = static_cast<int>(mechanism_.coordinates().size());
    plan_.efforts = request_.efforts;
    plan_.static_motion = scene_.static_motion;
    plan_.twists = request_.twists;
    plan_.gamma_root = plain(Vector3l(-scene_.gravity.cast<Real>()));
    return std::move(plan_);
  }

 private:
  void checkInertias() const {
    if (!scene_.strict_inertia) return;
    for (const Doubt& doubt : mechanism_.doubts()) {
      if (doubt.about_inertia) throw SceneError("strict_inertia: " + doubt.text);
    }
  }

  // Joint index of a requested reaction; -1 is ground.
  int jointOf(const std::string& name) const {
    if (name == kGround) return -1;
    const int joint = mechanism_.jointIndex(name);
    if (joint < 0) throw SceneError("reactions: the robot has no joint '" + name + "'");
    return joint;
  }

  void resolveReactions() {
    reported_.assign(mechanism_.links().size(), false);  // by child link; ground: the root link
    for (const auto* names : {&request_.child_axes, &request_.root_axes}) {
      for (const std::string& name : *names) reported_[jointOf(name) + 1] = true;
    }
  }

  // A body for the root and for every joint that moves or whose reaction is reported; the other
  // links are welded to their parent's body.
  void makeBodies() {
    places_.resize(mechanism_.links().size());
    plan_.bodies.emplace_back();
    for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
      const Joint& joint = mechanism_.joints()[k];
      const Placement& parent = places_[joint.parent_link];
      const Matrix3l R_PK = parent.R_ZL * joint.R_PK;
      const Vector3l p_PoKo_P = parent.p_ZoLo_Z + parent.R_ZL * joint.p_PoKo_P;
      if (joint.type == JointType::kFixed && !reported_[k + 1]) {
        places_[k + 1] = {parent.body, R_PK, p_PoKo_P};
        continue;
      }
      const Matrix3l R_KZ =
          joint.type == JointType::kFixed ? Matrix3l(Matrix3l::Identity()) : alignZ(joint.axis_K);
      places_[k + 1] = {static_cast<int>(plan_.bodies.size()), R_KZ.transpose(), Vector3l::Zero()};
      plan_.bodies.push_back(body(joint, parent.body, R_PK * R_KZ, p_PoKo_P));
    }
  }

  static Body<Real> body(const Joint& joint, int parent, const Matrix3l& R_PZ,
                         const Vector3l& p_PoZo_P) {
    Body<Real> body;
    body.parent = parent;
    body.mobility = joint.type == JointType::kFixed       ? Mobility::kFixed
                    : joint.type == JointType::kPrismatic ? Mobility::kPrismatic
                                                          : Mobility::kRevolute;
    body.coordinate = joint.coordinate;
    body.multiplier = joint.multiplier;
    body.offset = joint.offset;
    body.R_PZ = plain(R_PZ);
    body.p_PoZo_P = plain(p_PoZo_P);
    return body;
  }

  void addInertias() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Link& link = mechanism_.links()[i];
      const Placement& place = places_[i];
      Body<Real>& body = plan_.bodies[place.body];
      const Vector3l c = place.p_ZoLo_Z + place.R_ZL * link.p_KoCm_K;
      const Matrix3l& I = link.inertia_Cm_K;
      // Second moment about the centre of mass, then about O_k: both add up over welded links.
      const Matrix3l G_Cm = I.trace() / 2 * Matrix3l::Identity() - I;
      const Matrix3l G = place.R_ZL * G_Cm * place.R_ZL.transpose() + link.mass * c * c.transpose();
      body.mass += link.mass;
      body.h = body.h + link.mass * plain(c);
      body.G = {body.G.xx + G(0, 0), body.G.xy + G(0, 1), body.G.xz + G(0, 2),
                body.G.yy + G(1, 1), body.G.yz + G(1, 2), body.G.zz + G(2, 2)};
    }
  }

  // A body's wrench is needed when it is reported, drives a requested effort, or is part of its
  // parent's.
  void markNeeds() {
    for (std::size_t i = 0; i < reported_.size(); ++i) {
      if (reported_[i]) plan_.bodies[places_[i].body].wrench_needed = true;
    }
    for (Body<Real>& body : plan_.bodies) {
      if (request_.efforts && body.coordinate >= 0) body.wrench_needed = true;
      if (body.parent >= 0 && plan_.bodies[body.parent].wrench_needed) body.wrench_needed = true;
    }
  }

  void needPose(int body) {
    for (; body >= 0; body = plan_.bodies[body].parent) plan_.bodies[body].pose_needed = true;
  }

  ReactionOutput<Real> output(const std::string& name) const {
    const int joint = jointOf(name);
    ReactionOutput<Real> output;
    output.body = places_[joint + 1].body;
    output.R_KZ = plain(Matrix3l(places_[joint + 1].R_ZL.transpose()));
    output.drop_active = !scene_.include_active && joint >= 0;
    return output;
  }

  void addOutputs() {
    for (const std::string& name : request_.child_axes) plan_.child_axes.push_back(output(name));
    for (const std::string& name : request_.root_axes) {
      plan_.root_axes.push_back(output(name));
      needPose(plan_.root_axes.back().body);
    }
  }

  void addApplied() {
    for (const AppliedWrench& wrench : scene_.applied_wrenches) {
      const int link = mechanism_.linkIndex(wrench.link);
      if (link < 0) {
        throw SceneError("applied_wrenches: the robot has no link '" + wrench.link + "'");
      }
      const Placement& place = places_[link];
      AppliedOutside<Real> applied;
      applied.body = plan_.bodies[place.body].wrench_needed ? place.body : -1;
      applied.in_root_axes = wrench.axes == Axes::kRoot;
      applied.R_ZL = plain(place.R_ZL);
      applied.p_ZoA_Z = plain(Vector3l(place.p_ZoLo_Z + place.R_ZL * wrench.at.cast<Real>()));
      applied.force = plain(Vector3l(wrench.force.cast<Real>()));
      applied.torque = plain(Vector3l(wrench.torque.cast<Real>()));
      if (applied.in_root_axes) needPose(applied.body);
      plan_.applied.push_back(applied);
    }
  }

  // Keeps the bodies whose wrench is needed, their ancestors, and the root.
  void dropBodiesWithoutUse() {
    std::vector<bool> kept(plan_.bodies.size(), false);
    kept[0] = true;
    for (std::size_t k = plan_.bodies.size(); k-- > 1;) {
      if (plan_.bodies[k].wrench_needed) kept[k] = true;
      if (kept[k]) kept[plan_.bodies[k].parent] = true;
    }
    std::vector<int> renumbered(plan_.bodies.size(), -1);
    std::vector<Body<Real>> bodies;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (!kept[k]) continue;
      renumbered[k] = static_cast<int>(bodies.size());
      bodies.push_back(plan_.bodies[k]);
      if (k > 0) bodies.back().parent = renumbered[bodies.back().parent];
    }
    plan_.bodies = std::move(bodies);
    for (auto* outputs : {&plan_.child_axes, &plan_.root_axes}) {
      for (auto& output : *outputs) output.body = renumbered[output.body];
    }
    for (auto& applied : plan_.applied) {
      if (applied.body >= 0) applied.body = renumbered[applied.body];
    }
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  const Request& request_;
  std::vector<bool> reported_;
  std::vector<Placement> places_;
  Plan<Real> plan_;
};

template <typename T>
Vec3<T> rounded(const Vec3<Real>& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

template <typename T>
Mat3<T> rounded(const Mat3<Real>& A) {
  return {T(A.xx), T(A.xy), T(A.xz), T(A.yx), T(A.yy), T(A.yz), T(A.zx), T(A.zy), T(A.zz)};
}

template <typename T>
Sym3<T> rounded(const Sym3<Real>& A) {
  return {T(A.xx), T(A.xy), T(A.xz), T(A.yy), T(A.yz), T(A.zz)};
}

template <typename T>
Body<T> rounded(const Body<Real>& body) {
  return {body.parent,        body.mobility,         body.coordinate,           T(body.multiplier),
          T(body.offset),     rounded<T>(body.R_PZ), rounded<T>(body.p_PoZo_P), T(body.mass),
          rounded<T>(body.h), rounded<T>(body.G),    body.wrench_needed,        body.pose_needed};
}

template <typename T>
ReactionOutput<T> rounded(const ReactionOutput<Real>& output) {
  return {output.body, rounded<T>(output.R_KZ), output.drop_active};
}

template <typename T>
AppliedOutside<T> rounded(const AppliedOutside<Real>& applied) {
  return {applied.body,
          applied.in_root_axes,
          rounded<T>(applied.R_ZL),
          rounded<T>(applied.p_ZoA_Z),
          rounded<T>(applied.force),
          rounded<T>(applied.torque)};
}

}  // namespace

Plan<long double> compilePlan(const Mechanism& mechanism, const Scene& scene,
                              const Request& request) {
  return Compiler(mechanism, scene, request).compile();
}

template <typename T>
Plan<T> roundPlan(const Plan<long double>& plan) {
  Plan<T> result;
  result.coordinates = plan.coordinates;
  result.efforts = plan.efforts;
  result.static_motion = plan.static_motion;
  result.twists = plan.twists;
  result.gamma_root = rounded<T>(plan.gamma_root);
  for (const auto& body : plan.bodies) result.bodies.push_back(rounded<T>(body));
  for (const auto& output : plan.child_axes) result.child_axes.push_back(rounded<T>(output));
  for (const auto& output : plan.root_axes) result.root_axes.push_back(rounded<T>(output));
  for (const auto& applied : plan.applied) result.applied.push_back(rounded<T>(applied));
  return result;
}

template Plan<double> roundPlan<double>(const Plan<long double>&);

}  // namespace virtual_work_dynamics
