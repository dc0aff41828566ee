#include "tree/plan.h"

#include <algorithm>

#include "scene/input_checks.h"
#include "scene/joint_terms.h"
#include "scene/moment_points.h"
#include "tree/exact_products.h"
#include "tree/plan_reduction.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

using Real = long double;

// Index of the only entry of a unit vector, +-1; -1 when it has more.
int onlyEntry(const Vector3l& v) {
  for (int i = 0; i < 3; ++i) {
    if (v[i] != 0 && v[(i + 1) % 3] == 0 && v[(i + 2) % 3] == 0) return i;
  }
  return -1;
}

// Orientation of a frame whose z axis is `axis`: columns are its axes in K. A signed permutation
// for axes along +-x, +-y, +-z, so that those stay exact.
Matrix3l alignZ(const Vector3l& axis) {
  Matrix3l R_KZ;
  const int i = onlyEntry(axis);
  if (i >= 0) {
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
  return orthonormalized(R_KZ);
}

Vec3<Real> plain(const Vector3l& v) {
  return {v.x(), v.y(), v.z()};
}

Mat3<Real> plain(const Matrix3l& A) {
  return {A(0, 0), A(0, 1), A(0, 2), A(1, 0), A(1, 1), A(1, 2), A(2, 0), A(2, 1), A(2, 2)};
}

// Q of a frame whose z axis is `axis` in its parent's: see AxisDirection. Leaves Q as it is where
// the axis is oblique.
AxisDirection canonicalRotation(const Vector3l& axis, Matrix3l& Q) {
  const Real x = axis.x(), y = axis.y(), z = axis.z();
  if (x == 0) {
    Q << 1, 0, 0, 0, z, y, 0, -y, z;
    if (y == 0) return z > 0 ? AxisDirection::kPlusZ : AxisDirection::kMinusZ;
    if (z == 0) return y > 0 ? AxisDirection::kPlusY : AxisDirection::kMinusY;
    return AxisDirection::kNormalToX;
  }
  if (y == 0) {
    Q << z, 0, x, 0, 1, 0, -x, 0, z;
    if (z == 0) return x > 0 ? AxisDirection::kPlusX : AxisDirection::kMinusX;
    return AxisDirection::kNormalToY;
  }
  if (z == 0) {
    Q << 0, -y, x, 0, x, y, -1, 0, 0;
    return AxisDirection::kNormalToZ;
  }
  return AxisDirection::kOblique;
}

// Second moment of mass tr(I) / 2 - I, which stands for the inertia of (3.5). Of the two moments of
// inertia that are added on the diagonal the larger comes first: for a thin rod along an axis it
// cancels, and leaves all digits of the smaller one.
Matrix3l secondMoment(const Matrix3l& I) {
  Matrix3l G = -I;
  for (int i = 0; i < 3; ++i) {
    const Real a = I((i + 1) % 3, (i + 1) % 3), b = I((i + 2) % 3, (i + 2) % 3);
    G(i, i) = ((std::max(a, b) - I(i, i)) + std::min(a, b)) / 2;
  }
  return G;
}

// The body that a link of the description is part of, and the link's frame in it.
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
    openChain(scene_);
    requireSoundDescription(mechanism_, scene_);
    resolveReactions();
    plan_.coordinates = static_cast<int>(mechanism_.coordinates().size());
    plan_.orientations = static_cast<int>(mechanism_.orientations());
    plan_.efforts = request_.efforts;
    plan_.static_motion = scene_.static_motion;
    plan_.root_moves = scene_.root_moves;
    for (int i = 0; i < 3; ++i) plan_.gravity[i] = scene_.gravity[i];
    plan_.poses = request_.poses;
    plan_.twists = request_.twists;
    makeBodies();
    addInertias();
    addOutputs();
    addMovedMoments();
    addApplied();
    addActuators();
    // Departs from (3.6): gravity, a vector, becomes an acceleration of the root link.
    reducePlan(plan_, names_, plain(Vector3l(-scene_.gravity.cast<Real>())));
    return std::move(plan_);
  }

 private:
  void resolveReactions() {
    child_axes_links_ = linksOf(mechanism_, request_.child_axes);
    root_axes_links_ = linksOf(mechanism_, request_.root_axes);
    reported_.assign(mechanism_.links().size(), false);
    for (const auto* links : {&child_axes_links_, &root_axes_links_}) {
      for (const int link : *links) reported_[link] = true;
    }
  }

  // A body for the root and for every joint that moves or whose reaction is reported; the other
  // links are welded to their parent's body.
  void makeBodies() {
    places_.resize(mechanism_.links().size());
    plan_.bodies.emplace_back();
    names_.push_back(kGround);
    for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
      const Joint& joint = mechanism_.joints()[k];
      const Placement& parent = places_[joint.parent_link];
      const Matrix3l R_PK = exactProduct(parent.R_ZL, joint.R_PK);
      const Vector3l p_PoKo_P = exactProduct(parent.p_ZoLo_Z, parent.R_ZL, joint.p_PoKo_P);
      if (joint.type == JointType::kFixed && !reported_[k + 1]) {
        places_[k + 1] = {parent.body, R_PK, p_PoKo_P};
        plan_.left_out.merged.push_back(joint.name);
        continue;
      }
      const Matrix3l R_KZ =
          joint.coordinate < 0 ? Matrix3l(Matrix3l::Identity()) : alignZ(joint.axis_K);
      places_[k + 1] = {static_cast<int>(plan_.bodies.size()), R_KZ.transpose(), Vector3l::Zero()};
      addBody(joint, parent.body, orthonormalized(exactProduct(R_PK, R_KZ)), p_PoKo_P);
    }
  }

  void addBody(const Joint& joint, int parent, const Matrix3l& R_PZ, const Vector3l& p_PoZo_P) {
    Body<Real> body;
    body.parent = parent;
    body.mobility = joint.type == JointType::kFixed       ? Mobility::kFixed
                    : joint.type == JointType::kOriented  ? Mobility::kOriented
                    : joint.type == JointType::kPrismatic ? Mobility::kPrismatic
                                                          : Mobility::kRevolute;
    body.coordinate = joint.coordinate;
    body.orientation = joint.orientation;
    body.multiplier = joint.multiplier;
    body.geared = joint.multiplier != 1;
    body.p_PoZo_P = plain(p_PoZo_P);
    JointPosition<Real> position;
    position.coordinate = joint.coordinate;
    position.multiplier = joint.multiplier;
    position.offset = joint.offset;
    position.geared = joint.multiplier != 1 || joint.offset != 0;
    Matrix3l Q = R_PZ;
    body.axis = canonicalRotation(R_PZ.col(2), Q);
    if (body.mobility == Mobility::kRevolute) {
      const Matrix3l Rz = Q.transpose() * R_PZ;  // R_PZ = Q Rz(phase)
      position.phase_cos = Rz(0, 0);
      position.phase_sin = Rz(1, 0);
      position.turned = Rz(0, 0) != 1 || Rz(1, 0) != 0;
    }
    const bool canonical = body.mobility == Mobility::kRevolute || Q == R_PZ;
    if (!canonical || body.axis == AxisDirection::kOblique) {
      body.axis = AxisDirection::kOblique;
      position.turned = false;
      position.phase_cos = 1;
      position.phase_sin = 0;
      Q = R_PZ;
    }
    body.R_PZ = plain(Q);
    if (body.mobility == Mobility::kRevolute) {
      body.angle = static_cast<int>(plan_.angles.size());
      plan_.angles.push_back(position);
    } else if (body.mobility == Mobility::kPrismatic) {
      body.slide = static_cast<int>(plan_.slides.size());
      plan_.slides.push_back(position);
    }
    plan_.bodies.push_back(body);
    names_.push_back(joint.name);
  }

  void addInertias() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Link& link = mechanism_.links()[i];
      const Placement& place = places_[i];
      Body<Real>& body = plan_.bodies[place.body];
      const Vector3l c = exactProduct(place.p_ZoLo_Z, place.R_ZL, link.p_KoCm_K);
      // Second moment about the centre of mass, then about O_k: both add up over welded links.
      const Matrix3l G_Cm = secondMoment(link.inertia_Cm_K);
      const Matrix3l G = place.R_ZL * G_Cm * place.R_ZL.transpose() + link.mass * c * c.transpose();
      body.mass += link.mass;
      body.h = {body.h.x + link.mass * c.x(), body.h.y + link.mass * c.y(),  // (3.5), m r_C
                body.h.z + link.mass * c.z()};
      body.G = {body.G.xx + G(0, 0), body.G.xy + G(0, 1), body.G.xz + G(0, 2),
                body.G.yy + G(1, 1), body.G.yz + G(1, 2), body.G.zz + G(2, 2)};
    }
  }

  ReactionOutput<Real> output(int link) {
    ReactionOutput<Real> output;
    output.body = places_[link].body;
    output.R_KZ = plain(Matrix3l(places_[link].R_ZL.transpose()));
    output.drop_active = !scene_.include_active && link > 0;
    if (output.drop_active) setActivePart(link - 1, output);
    output.permutes = true;
    for (int i = 0; i < 3; ++i) {
      const Vector3l column = places_[link].R_ZL.row(i);  // of R_KZ
      output.row[i] = onlyEntry(column);
      if (output.row[i] < 0) {
        output.permutes = false;
      } else {
        output.sign[i] = column[output.row[i]];
        if (output.sign[i] < 0) output.flips = true;
      }
    }
    return output;
  }

  // The parts of a compound joint are not welded to each other, so that each is a body.
  void setActivePart(int joint, ReactionOutput<Real>& output) {
    const CompoundJoint* const compound = mechanism_.compoundOf(joint);
    if (!compound) return;
    switch (compound->type) {
      case CompoundType::kPlanar:
        output.active = ActivePart::kPlane;
        return;
      case CompoundType::kCylindrical:
        output.active = ActivePart::kCylinder;
        return;
      case CompoundType::kScrew:
        output.active = ActivePart::kScrew;
        output.pitch = mechanism_.joint(compound->first).multiplier;
        return;
      case CompoundType::kSpherical:
        output.active = ActivePart::kBall;
        return;
      case CompoundType::kFloating:
        output.active = ActivePart::kAll;
        return;
      case CompoundType::kUniversal:
        break;
    }
    const Vector3l normal =
        mechanism_.joint(compound->first).axis_K.cross(mechanism_.joint(joint).axis_K).normalized();
    output.active = ActivePart::kCross;
    output.normal_P = plain(Vector3l(places_[compound->first + 1].R_ZL * normal));
    // The normal turns with the first part: the position of the last one says where it is.
    plan_.bodies[places_[joint + 1].body].bears_point = true;
  }

  void addOutputs() {
    for (const int link : child_axes_links_) plan_.child_axes.push_back(output(link));
    for (const int link : root_axes_links_) plan_.root_axes.push_back(output(link));
  }

  void addMovedMoments() {
    const MomentPoints points(mechanism_, scene_);
    const auto add = [&](const std::vector<int>& links, bool in_root_axes) {
      for (std::size_t i = 0; i < links.size(); ++i) {
        const LinkPoint* point = links[i] > 0 ? points.ofJoint(links[i] - 1) : nullptr;
        if (!point) continue;
        const Placement& place = places_[point->link];
        MovedMoment<Real> moved;
        moved.output = static_cast<int>(i);
        moved.in_root_axes = in_root_axes;
        moved.p_ZoPo_Z = plain(exactProduct(place.p_ZoLo_Z, place.R_ZL, point->p_LoPo_L));
        moved.steps_begin = static_cast<int>(plan_.point_steps.size());
        addPointSteps(place.body, places_[links[i]].body);
        moved.steps_end = static_cast<int>(plan_.point_steps.size());
        plan_.moved.push_back(moved);
      }
    };
    if (!request_.child_axes_about_origin) add(child_axes_links_, false);
    add(root_axes_links_, true);
  }

  // The way between two bodies leads through the last body that carries both.
  void addPointSteps(int from, int to) {
    std::vector<PointStep> down;
    while (from != to) {
      int& later = from > to ? from : to;
      if (&later == &to) {
        down.push_back({to, true});
      } else {
        plan_.point_steps.push_back({from, false});
      }
      later = plan_.bodies[later].parent;
    }
    plan_.point_steps.insert(plan_.point_steps.end(), down.rbegin(), down.rend());
  }

  void addApplied() {
    requireWrenchNames(scene_);
    for (std::size_t i = 0; i < scene_.applied_wrenches.size(); ++i) {
      const AppliedWrench& wrench = scene_.applied_wrenches[i];
      const Placement& place = places_[linkOf(mechanism_, scene_, i)];
      AppliedOutside<Real> applied;
      applied.body = place.body;
      applied.in_root_axes = wrench.axes == Axes::kRoot;  // (3.6), f* and m* other than weight
      applied.R_ZL = plain(place.R_ZL);
      applied.p_ZoA_Z = plain(Vector3l(place.p_ZoLo_Z + place.R_ZL * wrench.at.cast<Real>()));
      applied.given = {plain(Vector3l(wrench.force.cast<Real>())),
                       plain(Vector3l(wrench.torque.cast<Real>()))};
      plan_.applied.push_back(applied);
    }
  }

  void addActuators() {
    for (const ResolvedJointTerms& terms : resolveJointTerms(mechanism_, scene_)) {
      const Joint& joint = mechanism_.joints()[static_cast<std::size_t>(terms.joint)];
      if (request_.efforts) {
        plan_.actuators.push_back({joint.coordinate, Real(joint.multiplier),
                                   Real(joint.offset) - Real(terms.rest), terms.stiffness,
                                   terms.damping, terms.coulomb, 1 / Real(terms.coulomb_velocity),
                                   terms.rotor_inertia, terms.offset});
      }
    }
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  const Request& request_;
  std::vector<int> child_axes_links_, root_axes_links_;  // child links of requested reactions
  std::vector<bool> reported_;  // by child link, ground by the root link: whether it is requested
  std::vector<Placement> places_;
  std::vector<std::string> names_;  // the joint that each body hangs on
  Plan<Real> plan_;
};

}  // namespace

Plan<long double> compilePlan(const Mechanism& mechanism, const Scene& scene,
                              const Request& request) {
  return Compiler(mechanism, scene, request).compile();
}

}  // namespace virtual_work_dynamics
