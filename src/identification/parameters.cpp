#include <array>
#include <utility>

#include "base/printable.h"
#include "scene/joint_terms.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/regressor.h"

namespace virtual_work_dynamics {
namespace {

// A mass with its first moments and moments of inertia about an origin.
struct Moments {
  long double mass = 0;
  Vector3l first = Vector3l::Zero();
  Matrix3l inertia = Matrix3l::Zero();
};

Matrix3l inertiaOfProducts(const Vector3l& a, const Vector3l& b) {
  return a.dot(b) * Matrix3l::Identity() - (a * b.transpose() + b * a.transpose()) / 2;
}

Moments momentsOf(const Link& link) {
  const Vector3l& c = link.p_KoCm_K;
  return {link.mass, link.mass * c, link.inertia_Cm_K + link.mass * inertiaOfProducts(c, c)};
}

// Adds what a fixed joint holds: moments about its child's origin, in the child's axes.
void addThrough(const Joint& joint, const Moments& child, Moments& parent) {
  const Vector3l& p = joint.p_PoKo_P;
  const Vector3l first = joint.R_PK * child.first;
  parent.mass += child.mass;
  parent.first += first + child.mass * p;
  parent.inertia += joint.R_PK * child.inertia * joint.R_PK.transpose() +
                    2 * inertiaOfProducts(p, first) + child.mass * inertiaOfProducts(p, p);
}

bool isMoved(const Mechanism& mechanism, int link) {
  for (int i = link; i != 0;) {
    const Joint& joint = mechanism.joint(mechanism.link(i).parent_joint);
    if (joint.type != JointType::kFixed) return true;
    i = joint.parent_link;
  }
  return false;
}

}  // namespace

const char* nameOf(ParameterKind kind) {
  static constexpr std::array<const char*, 14> kNames{
      "mass",       "first_moment_x", "first_moment_y", "first_moment_z", "inertia_xx",
      "inertia_xy", "inertia_xz",     "inertia_yy",     "inertia_yz",     "inertia_zz",
      "damping",    "coulomb",        "rotor_inertia",  "offset"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<Parameter> inertialParameters(const Mechanism& mechanism, const std::string& link) {
  const int index = linkNamed(mechanism, link, "parameters");
  if (!isMoved(mechanism, index)) {
    throw SceneError("parameters: no joint moves " + inQuotes(link) +
                     ", so that no effort depends on its mass");
  }
  // Children stand after their parents.
  std::vector<Moments> moments;
  for (const Link& each : mechanism.links()) moments.push_back(momentsOf(each));
  for (int k = static_cast<int>(mechanism.joints().size()) - 1; k >= index; --k) {
    const Joint& joint = mechanism.joint(k);
    if (joint.type != JointType::kFixed) continue;
    addThrough(joint, moments[static_cast<std::size_t>(joint.child_link)],
               moments[static_cast<std::size_t>(joint.parent_link)]);
  }
  const Moments& all = moments[static_cast<std::size_t>(index)];
  const Matrix3l& inertia = all.inertia;
  const std::pair<ParameterKind, long double> values[] = {
      {ParameterKind::kMass, all.mass},
      {ParameterKind::kFirstMomentX, all.first.x()},
      {ParameterKind::kFirstMomentY, all.first.y()},
      {ParameterKind::kFirstMomentZ, all.first.z()},
      {ParameterKind::kInertiaXX, inertia(0, 0)},
      {ParameterKind::kInertiaXY, inertia(0, 1)},
      {ParameterKind::kInertiaXZ, inertia(0, 2)},
      {ParameterKind::kInertiaYY, inertia(1, 1)},
      {ParameterKind::kInertiaYZ, inertia(1, 2)},
      {ParameterKind::kInertiaZZ, inertia(2, 2)}};
  std::vector<Parameter> parameters;
  for (const auto& [kind, value] : values) {
    parameters.push_back({kind, link, static_cast<double>(value)});
  }
  return parameters;
}

std::vector<std::string> bodies(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
    const Joint& joint = mechanism.joints()[k];
    if (joint.type == JointType::kFixed || mechanism.isInnerPart(static_cast<int>(k))) continue;
    names.push_back(mechanism.link(joint.child_link).name);
  }
  return names;
}

std::vector<Parameter> jointParameters(const Mechanism& mechanism, const Scene& scene) {
  std::vector<ResolvedJointTerms> terms(mechanism.joints().size());
  for (const ResolvedJointTerms& each : resolveJointTerms(mechanism, scene)) {
    terms[static_cast<std::size_t>(each.joint)] = each;
  }
  std::vector<Parameter> parameters;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Joint& joint = mechanism.joints()[k];
    if (joint.coordinate < 0) continue;
    parameters.push_back({ParameterKind::kDamping, joint.name, terms[k].damping});
    parameters.push_back({ParameterKind::kCoulomb, joint.name, terms[k].coulomb});
    parameters.push_back({ParameterKind::kRotorInertia, joint.name, terms[k].rotor_inertia});
    parameters.push_back({ParameterKind::kOffset, joint.name, terms[k].offset});
  }
  return parameters;
}

}  // namespace virtual_work_dynamics
