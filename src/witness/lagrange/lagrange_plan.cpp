#include "witness/lagrange/lagrange_plan.h"

#include <algorithm>

#include "scene/input_checks.h"
#include "scene/moment_points.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

template <typename Real, typename Vector>
Triple<Real> triple(const Vector& v) {
  return {static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])};
}

template <typename Real>
Matrix<Real> matrix(const Matrix3l& A) {
  return {triple<Real>(A.row(0)), triple<Real>(A.row(1)), triple<Real>(A.row(2))};
}

template <typename Real>
typename LagrangePlan<Real>::JointData jointData(const Joint& joint) {
  typename LagrangePlan<Real>::JointData data;
  const bool oriented = joint.type == JointType::kOriented;
  data.type = oriented ? JointType::kFixed : joint.type;
  data.orientation = joint.orientation;
  data.parent = joint.parent_link;
  data.coordinate = joint.coordinate;
  data.multiplier = joint.multiplier;
  data.offset = joint.offset;
  data.p_PoKo_P = triple<Real>(joint.p_PoKo_P);
  data.R_PK = data.frame = matrix<Real>(joint.R_PK);
  data.axis_K = triple<Real>(joint.axis_K);
  data.axis_P = triple<Real>(joint.R_PK * joint.axis_K);
  const Vector3l& u = joint.axis_K;
  Matrix3l cross;
  cross << 0, -u.z(), u.y(), u.z(), 0, -u.x(), -u.y(), u.x(), 0;
  const Matrix3l along = u * u.transpose();
  data.along = matrix<Real>(joint.R_PK * along);
  data.sine = matrix<Real>(joint.R_PK * cross);
  data.cosine = matrix<Real>(joint.R_PK * (Matrix3l::Identity() - along));
  return data;
}

template <typename Real>
typename LagrangePlan<Real>::LinkData linkData(const Link& link) {
  typename LagrangePlan<Real>::LinkData data;
  data.mass = static_cast<Real>(link.mass);
  data.p_KoCm_K = triple<Real>(link.p_KoCm_K);
  data.has_inertia = !link.inertia_Cm_K.isZero(0);
  data.inertia_Cm_K = matrix<Real>(link.inertia_Cm_K);
  return data;
}

template <typename Real>
void addApplied(const Mechanism& mechanism, const Scene& scene, LagrangePlan<Real>& plan) {
  for (std::size_t i = 0; i < scene.applied_wrenches.size(); ++i) {
    const AppliedWrench& wrench = scene.applied_wrenches[i];
    const int link = linkOf(mechanism, scene, i);
    auto& applied = plan.links[link].applied;
    plan.applied.push_back({link, applied.size()});
    applied.push_back({wrench.axes == Axes::kRoot, triple<Real>(wrench.at),
                       triple<Real>(wrench.force), triple<Real>(wrench.torque)});
  }
}

// Whether anything that a link carries has inertia or is pushed; what does not is left out.
template <typename Real>
std::vector<bool> linksThatMatter(const LagrangePlan<Real>& plan) {
  std::vector<bool> matters;
  for (const auto& link : plan.links) {
    matters.push_back(link.mass != 0 || link.has_inertia || !link.applied.empty());
  }
  for (std::size_t k = plan.joints.size(); k > 0; --k) {
    if (matters[k]) matters[plan.joints[k - 1].parent] = true;
  }
  return matters;
}

template <typename Real>
void addCoordinates(const std::vector<ResolvedJointTerms>& resolved,
                    const std::vector<bool>& matters, LagrangePlan<Real>& plan) {
  plan.coordinates.resize(plan.coordinate_count);
  for (int i = 0; i < plan.coordinate_count; ++i) {
    std::vector<bool> depends(plan.links.size(), false);
    for (std::size_t k = 0; k < plan.joints.size(); ++k) {
      const bool parent_depends = depends[plan.joints[k].parent];
      const bool joint_depends = plan.joints[k].coordinate == i;
      depends[k + 1] = (parent_depends || joint_depends) && matters[k + 1];
      if (depends[k + 1]) {
        plan.coordinates[i].steps.push_back(
            {static_cast<int>(k) + 1, parent_depends, joint_depends});
      }
    }
  }
  for (const ResolvedJointTerms& terms : resolved) {
    plan.coordinates[plan.joints[terms.joint].coordinate].terms.push_back(terms);
  }
}

template <typename Real>
typename LagrangePlan<Real>::Reaction makeReaction(int link, const Scene& scene,
                                                   const std::vector<bool>& matters,
                                                   const LagrangePlan<Real>& plan) {
  typename LagrangePlan<Real>::Reaction reaction;
  reaction.link = link;
  reaction.drop_active = !scene.include_active && link > 0;
  std::vector<bool> carried(plan.links.size(), false);
  carried[link] = true;
  for (std::size_t k = link; k < plan.joints.size(); ++k) {
    if (!carried[plan.joints[k].parent] || !matters[k + 1]) continue;
    carried[k + 1] = true;
    reaction.links.push_back(static_cast<int>(k) + 1);
  }
  return reaction;
}

template <typename Reaction>
void addParts(const Mechanism& mechanism, Reaction& reaction) {
  const CompoundJoint* const compound = mechanism.compoundOf(reaction.link - 1);
  if (!compound) return;
  reaction.ball = compound->turnsFreely();
  reaction.screw = compound->type == CompoundType::kScrew;
  for (int k = compound->first; k <= compound->last; ++k) reaction.parts.push_back(k);
}

template <typename Reaction>
void moveTo(const LinkPoint& point, Reaction& reaction) {
  reaction.moved = true;
  reaction.point_link = point.link;
  for (int i = 0; i < 3; ++i) reaction.point[i] = point.p_LoPo_L[i];
}

}  // namespace

template <typename Real>
LagrangePlan<Real>::LagrangePlan(const Mechanism& mechanism, const Scene& scene,
                                 const Request& request)
    : gravity(triple<Real>(scene.gravity)),
      static_motion(scene.static_motion),
      root_moves(scene.root_moves),
      coordinate_count(static_cast<int>(mechanism.coordinates().size())) {
  openChain(scene);
  requireSoundDescription(mechanism, scene);
  for (const Joint& joint : mechanism.joints()) joints.push_back(jointData<Real>(joint));
  for (const Link& link : mechanism.links()) links.push_back(linkData<Real>(link));
  addApplied(mechanism, scene, *this);
  const std::vector<bool> matters = linksThatMatter(*this);
  const std::vector<ResolvedJointTerms> terms = resolveJointTerms(mechanism, scene);
  if (request.efforts) addCoordinates(terms, matters, *this);

  const MomentPoints points(mechanism, scene);
  std::vector<int> reaction_of[2];  // about O_k, about points of their own; by child link
  for (std::vector<int>& of : reaction_of) of.assign(links.size(), -1);
  const auto indices = [&](const std::vector<std::string>& names, bool about_origin) {
    std::vector<int> result = linksOf(mechanism, names);
    for (int& entry : result) {
      const LinkPoint* point = about_origin || entry == 0 ? nullptr : points.ofJoint(entry - 1);
      int& index = reaction_of[point ? 1 : 0][entry];
      if (index < 0) {
        index = static_cast<int>(reactions.size());
        reactions.push_back(makeReaction(entry, scene, matters, *this));
        if (point) moveTo(*point, reactions.back());
        if (reactions.back().drop_active) addParts(mechanism, reactions.back());
      }
      entry = index;
    }
    return result;
  };
  child_axes = indices(request.child_axes, request.child_axes_about_origin);
  root_axes = indices(request.root_axes, false);
}

template struct LagrangePlan<double>;
template struct LagrangePlan<long double>;

}  // namespace virtual_work_dynamics
