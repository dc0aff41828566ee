#include "virtual_work_dynamics/lagrange_dynamics.h"

#include <cmath>
#include <string>

#include "scene/input_checks.h"
#include "scene/payloads.h"
#include "virtual_work_dynamics/error.h"
#include "witness/geared_angle.h"
#include "witness/lagrange/lagrange_equations.h"
#include "witness/lagrange/lagrange_plan.h"
#include "witness/lagrange/triples.h"

namespace virtual_work_dynamics {

namespace {

template <typename Real>
struct RealWrench {
  Triple<Real> force, torque;
};

// Takes the force along a joint's axis, or the moment about it, away; the axis of a fixed joint is
// zero. `lever` leads to O_k, on the axis, from the point that the moment is about.
template <typename Real>
void dropActive(JointType type, const Triple<Real>& axis, const Triple<Real>& lever,
                RealWrench<Real>& wrench) {
  if (type == JointType::kPrismatic) {
    const Triple<Real> active = times(-dot(axis, wrench.force), axis);
    wrench.force = wrench.force + active;
    wrench.torque = wrench.torque + cross(lever, active);
  } else {
    const Real about_point = dot(axis, wrench.torque);
    const Real about_axis = about_point - dot(axis, cross(lever, wrench.force));
    wrench.torque = wrench.torque + times(-about_axis, axis);
  }
}

}  // namespace

template <typename Real>
struct LagrangeDynamics<Real>::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& wanted)
      : request(wanted),
        plan(mechanism, scene, wanted),
        own_load(scene),
        states(plan.joints.size()),
        poses(plan.joints.size()),
        axes(plan.links.size()),
        origins(plan.links.size()),
        axes_1(plan.coordinates.empty() ? 0 : plan.links.size()),
        origins_1(axes_1.size()),
        axes_3(plan.reactions.empty() ? 0 : plan.links.size()),
        origins_3(axes_3.size()),
        reactions(plan.reactions.size()),
        effort(Eigen::VectorXd::Zero(plan.coordinates.size())),
        child_axes(plan.child_axes.size()),
        root_axes(plan.root_axes.size()),
        orientations(mechanism.orientations()) {
    for (std::size_t i = 0; i < 3; ++i) axes[0].R[i][i].value = 1;
    gravity = plan.gravity;
  }

  void take(const Load& load);
  void moveRoot(const RootMotion& motion);
  void orient(std::size_t k, const Motion& motion);
  void move(const Motion& motion);
  Real effortOf(const typename LagrangePlan<Real>::Coordinate& coordinate);
  void displace(const typename LagrangePlan<Real>::Reaction& reaction, Triple<Real>& force);
  Triple<Real> leverOf(const typename LagrangePlan<Real>::Reaction& reaction) const;
  void dropActiveOfParts(const typename LagrangePlan<Real>::Reaction& reaction,
                         RealWrench<Real>& wrench) const;
  void rotate(const typename LagrangePlan<Real>::Reaction& reaction, Triple<Real>& torque);
  void output();

  Request request;
  LagrangePlan<Real> plan;
  Load own_load;         // the values in the scene
  Triple<Real> gravity;  // axes of the root link, m/s^2
  std::vector<JointState<Real>> states;
  std::vector<RelativePose<Real, 0>> poses;  // by joint; the other frames are by link
  std::vector<Orientation<Real, 0>> axes;
  std::vector<Origin<Real, 0>> origins;
  // Frames of links as they depend on one coordinate, or on the fictitious mobility of one joint.
  std::vector<Orientation<Real, 1>> axes_1;
  std::vector<Origin<Real, 1>> origins_1;
  std::vector<Orientation<Real, 3>> axes_3;
  std::vector<Origin<Real, 3>> origins_3;
  std::vector<RealWrench<Real>> reactions;  // in child axes
  Eigen::VectorXd effort;
  std::vector<Wrench> child_axes, root_axes;
  std::size_t orientations;  // of a motion
};

// The root's pose is a given function of time. The inertial frame is the one whose axes are the
// root's at the instant, and in which its origin has no velocity.
template <typename Real>
void LagrangeDynamics<Real>::Impl::moveRoot(const RootMotion& motion) {
  const Matrix<Real> R_0I = turnedBack<Real>(motion.orientation);
  gravity = R_0I * plan.gravity;
  if (plan.static_motion) return;
  const Matrix<Real> w = crossMatrix(R_0I * tripleOf<Real>(motion.angular_velocity));
  const Matrix<Real> ww = w * w;
  const Matrix<Real> alpha = crossMatrix(R_0I * tripleOf<Real>(motion.angular_acceleration));
  const Triple<Real> a = R_0I * tripleOf<Real>(motion.acceleration);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      axes[0].R[i][j].rate = axes[0].Rdot[i][j].value = w[i][j];
      axes[0].Rdot[i][j].rate = ww[i][j] + alpha[i][j];
    }
    origins[0].odot[i].rate = a[i];
  }
}

// The orientation of a sample is a constant of its equations: what turns on from it are angles.
template <typename Real>
void LagrangeDynamics<Real>::Impl::orient(std::size_t k, const Motion& motion) {
  auto& joint = plan.joints[k];
  const Eigen::Quaterniond turn =
      motion.orientations.empty()
          ? Eigen::Quaterniond::Identity()
          : motion.orientations[static_cast<std::size_t>(joint.orientation)];
  const Matrix<Real> back = turnedBack<Real>(turn);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) joint.R_PK[i][j] = dot(joint.frame[i], back[j]);
  }
}

template <typename Real>
void LagrangeDynamics<Real>::Impl::move(const Motion& motion) {
  if (plan.root_moves) moveRoot(motion.root);
  for (std::size_t k = 0; k < plan.joints.size(); ++k) {
    const auto& joint = plan.joints[k];
    if (joint.orientation >= 0) orient(k, motion);
    if (joint.coordinate >= 0) {
      JointState<Real>& state = states[k];
      state.q = joint.multiplier * Real(motion.q[joint.coordinate]) + joint.offset;
      if (!plan.static_motion) {
        state.qd = joint.multiplier * Real(motion.qd[joint.coordinate]);
        state.qdd = joint.multiplier * Real(motion.qdd[joint.coordinate]);
      }
      if (joint.type != JointType::kPrismatic)
        gearedCosineAndSine(joint.multiplier, Real(motion.q[joint.coordinate]), joint.offset,
                            state.cosine, state.sine);
      poses[k] = relativePose(joint, state, std::array<Real, 0>{});
    }
    axes[k + 1] = childOrientation<Real>(joint, poses[k], axes[joint.parent]);
    origins[k + 1] = childOrigin<Real>(joint, poses[k], axes[joint.parent], origins[joint.parent]);
  }
}

// Equation (4.1) of one coordinate, solved for its generalized force.
template <typename Real>
Real LagrangeDynamics<Real>::Impl::effortOf(
    const typename LagrangePlan<Real>::Coordinate& coordinate) {
  Real sum = 0;
  for (const auto& step : coordinate.steps) {
    const std::size_t k = step.link - 1;
    const auto& joint = plan.joints[k];
    const int parent = joint.parent;
    Orientation<Real, 1>& link_axes = axes_1[step.link];
    Origin<Real, 1>& origin = origins_1[step.link];
    if (!step.joint_depends) {
      link_axes = childOrientation<Real>(joint, poses[k], axes_1[parent]);
      origin = childOrigin<Real>(joint, poses[k], axes_1[parent], origins_1[parent]);
    } else {
      const auto pose = relativePose(joint, states[k], std::array<Real, 1>{joint.multiplier});
      if (step.parent_depends) {
        link_axes = composed(axes_1[parent], pose.orientation);
        origin = composed(axes_1[parent], origins_1[parent], pose.origin);
      } else {
        link_axes = composed(axes[parent], pose.orientation);
        origin = composed(axes[parent], origins[parent], pose.origin);
      }
    }
    sum += linkForce<Real>(plan.links[step.link], gravity, link_axes, origin)[0];  // (4.1)
  }
  for (const ResolvedJointTerms& terms : coordinate.terms) {
    sum += termsForce(terms, states[terms.joint], plan.joints[terms.joint].multiplier);
  }
  return sum;
}

// The force of a reaction by (4.2). The fictitious mobility sits after the joint's own motion, at
// O_k in child axes. A displacement turns no link, so the orientations are those of the motion.
template <typename Real>
void LagrangeDynamics<Real>::Impl::displace(const typename LagrangePlan<Real>::Reaction& reaction,
                                            Triple<Real>& force) {
  const int own = reaction.link;
  origins_3[own] = composed(axes[own], origins[own], fictitiousDisplacement<Real>());
  force = linkForce<Real>(plan.links[own], gravity, axes[own], origins_3[own]);
  for (const int link : reaction.links) {
    const auto& joint = plan.joints[link - 1];
    origins_3[link] =
        childOrigin<Real>(joint, poses[link - 1], axes[joint.parent], origins_3[joint.parent]);
    add(linkForce<Real>(plan.links[link], gravity, axes[link], origins_3[link]),
        force);  // (4.2)
  }
}

// The vector to O_k from the point that the moment of a reaction is about, in child axes.
template <typename Real>
Triple<Real> LagrangeDynamics<Real>::Impl::leverOf(
    const typename LagrangePlan<Real>::Reaction& reaction) const {
  if (!reaction.moved) return {};
  const auto at = axes[reaction.point_link].R * reaction.point;
  Triple<Real> lever;
  for (std::size_t i = 0; i < 3; ++i) {
    lever[i] =
        (origins[reaction.link].o[i].value - origins[reaction.point_link].o[i].value) - at[i].value;
  }
  return transposed(values(axes[reaction.link]), lever);
}

// The moment of a reaction by (4.2), with rotations at the place of displace()'s displacements: a
// rotation before a joint that slides would be about another point than O_k. Where the moment is
// about a point of its own, they are about the point of the child link that is there at the
// instant: virtual work asks for displacements, not for how the point moves.
template <typename Real>
void LagrangeDynamics<Real>::Impl::rotate(const typename LagrangePlan<Real>::Reaction& reaction,
                                          Triple<Real>& torque) {
  const int own = reaction.link;
  axes_3[own] = composed(axes[own], fictitiousRotation<Real>());
  const Triple<Real> lever = leverOf(reaction);
  const Origin<Real, 0> centre = composed(axes[own], origins[own], times(Real(-1), lever));
  origins_3[own] = composed(axes_3[own], centre, lever);
  torque = linkForce<Real>(plan.links[own], gravity, axes_3[own], origins_3[own]);
  for (const int link : reaction.links) {
    const auto& joint = plan.joints[link - 1];
    const auto& pose = poses[link - 1];
    axes_3[link] = childOrientation<Real>(joint, pose, axes_3[joint.parent]);
    origins_3[link] = childOrigin<Real>(joint, pose, axes_3[joint.parent], origins_3[joint.parent]);
    add(linkForce<Real>(plan.links[link], gravity, axes_3[link], origins_3[link]),
        torque);  // (4.2)
  }
}

// Takes away what the actuators of a joint of several freedoms deliver: forces along its slides,
// moments about one axis or in the plane of two. Those of a screw deliver a moment whose work is
// that of moment and force.
template <typename Real>
void LagrangeDynamics<Real>::Impl::dropActiveOfParts(
    const typename LagrangePlan<Real>::Reaction& reaction, RealWrench<Real>& wrench) const {
  const Triple<Real> lever = leverOf(reaction);
  Triple<Real> force = wrench.force;
  Triple<Real> moment = wrench.torque + times(Real(-1), cross(lever, force));  // about O_k
  std::array<Triple<Real>, 2> turns{};
  std::size_t count = 0;
  Real by_force = 0;
  for (const int k : reaction.parts) {
    const auto& joint = plan.joints[k];
    const Triple<Real> axis =
        transposed(values(axes[reaction.link]), values(axes[k + 1]) * joint.axis_K);
    if (joint.coordinate < 0) continue;
    if (joint.type != JointType::kPrismatic) {
      if (!reaction.ball) turns[count++] = axis;
    } else if (reaction.screw) {
      by_force = joint.multiplier * dot(axis, force);
    } else {
      force = force + times(-dot(axis, force), axis);
    }
  }
  if (reaction.ball) {
    moment = {};
  } else if (count == 1) {
    moment = moment + times(-(dot(turns[0], moment) + by_force), turns[0]);
  } else {
    const Triple<Real> normal = cross(turns[0], turns[1]);
    moment = times(dot(normal, moment) / dot(normal, normal), normal);
  }
  wrench = {force, moment + cross(lever, force)};
}

template <typename Real>
void LagrangeDynamics<Real>::Impl::take(const Load& load) {
  requireLoad(load, plan.applied.size());
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    auto& applied = plan.links[plan.applied[i].link].applied[plan.applied[i].index];
    applied.force = tripleOf<Real>(load.wrenches[i].force);
    applied.torque = tripleOf<Real>(load.wrenches[i].torque);
  }
}

template <typename Real>
void LagrangeDynamics<Real>::Impl::output() {
  for (std::size_t i = 0; i < plan.child_axes.size(); ++i) {
    const RealWrench<Real>& wrench = reactions[plan.child_axes[i]];
    child_axes[i] = {toDouble(wrench.force), toDouble(wrench.torque)};
  }
  for (std::size_t i = 0; i < plan.root_axes.size(); ++i) {
    const RealWrench<Real>& wrench = reactions[plan.root_axes[i]];
    const Matrix<Real> R_0K = values(axes[plan.reactions[plan.root_axes[i]].link]);
    root_axes[i] = {toDouble(R_0K * wrench.force), toDouble(R_0K * wrench.torque)};  // (4.3)
  }
}

template <typename Real>
LagrangeDynamics<Real>::LagrangeDynamics(const Mechanism& mechanism, const Scene& scene,
                                         const Request& request)
    : impl_(new Impl(LoadedMechanism(mechanism, scene).get(), scene, request)) {}

template <typename Real>
LagrangeDynamics<Real>::~LagrangeDynamics() = default;
template <typename Real>
LagrangeDynamics<Real>::LagrangeDynamics(LagrangeDynamics&&) noexcept = default;
template <typename Real>
LagrangeDynamics<Real>& LagrangeDynamics<Real>::operator=(LagrangeDynamics&&) noexcept = default;

template <typename Real>
Eigen::Index LagrangeDynamics<Real>::coordinates() const {
  return impl_->plan.coordinate_count;
}

template <typename Real>
const Request& LagrangeDynamics<Real>::request() const {
  return impl_->request;
}

template <typename Real>
void LagrangeDynamics<Real>::compute(const Motion& motion) {
  compute(motion, impl_->own_load);
}

template <typename Real>
void LagrangeDynamics<Real>::compute(const Motion& motion, const Load& load) {
  Impl& impl = *impl_;
  requireLengths(motion, coordinates());
  requireOrientations(motion, impl.orientations);
  impl.take(load);
  impl.move(motion);
  for (std::size_t i = 0; i < impl.plan.coordinates.size(); ++i) {
    impl.effort[i] = static_cast<double>(impl.effortOf(impl.plan.coordinates[i]));
  }
  for (std::size_t i = 0; i < impl.reactions.size(); ++i) {
    const auto& reaction = impl.plan.reactions[i];
    auto& wrench = impl.reactions[i];
    impl.displace(reaction, wrench.force);
    impl.rotate(reaction, wrench.torque);
    if (!reaction.parts.empty()) {
      impl.dropActiveOfParts(reaction, wrench);
    } else if (reaction.drop_active) {
      const auto& joint = impl.plan.joints[reaction.link - 1];
      dropActive(joint.type, joint.axis_K, impl.leverOf(reaction), wrench);
    }
  }
  impl.output();
}

template <typename Real>
const Eigen::VectorXd& LagrangeDynamics<Real>::effort() const {
  return impl_->effort;
}

template <typename Real>
const std::vector<Wrench>& LagrangeDynamics<Real>::childAxes() const {
  return impl_->child_axes;
}

template <typename Real>
const std::vector<Wrench>& LagrangeDynamics<Real>::rootAxes() const {
  return impl_->root_axes;
}

template class LagrangeDynamics<double>;
template class LagrangeDynamics<long double>;

}  // namespace virtual_work_dynamics
