#include "virtual_work_dynamics/inverse_dynamics.h"

#include <cmath>
#include <utility>

#include "core/plan.h"
#include "core/recursion.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

struct InverseDynamics::Impl {
  Request request;
  Plan<double> plan;
};

struct Workspace::Scratch {
  std::vector<BodyState<double>> states;
  std::vector<PlainWrench<double>> applied;
  const InverseDynamics::Impl* plan;  // only compared, and asked where applied wrenches act
};

namespace {

Vec3<double> plain(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Vector3d toEigen(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}

Eigen::Matrix3d toEigen(const Mat3<double>& A) {
  Eigen::Matrix3d matrix;
  matrix << A.xx, A.xy, A.xz, A.yx, A.yy, A.yz, A.zx, A.zy, A.zz;
  return matrix;
}

Wrench toWrench(const PlainWrench<double>& wrench) {
  return {toEigen(wrench.force), toEigen(wrench.torque)};
}

PlainWrench<double> appliedValue(const AppliedOutside<double>& where, const Vec3<double>& force,
                                 const Vec3<double>& torque) {
  if (where.in_root_axes) return {force, torque};
  const Vec3<double> force_Z = where.R_ZL * force;
  return {force_Z, where.R_ZL * torque + cross(where.p_ZoA_Z, force_Z)};
}

Request everything(const Mechanism& mechanism, const Scene& scene) {
  Request request;
  request.child_axes = requestedReactions(mechanism, scene);
  request.root_axes = request.child_axes;
  return request;
}

// R_KZ^T of an output is its R_ZK.
Pose poseOf(const ReactionOutput<double>& output, const BodyState<double>& state) {
  const Eigen::Matrix3d R_0K = toEigen(state.R_0Z) * toEigen(output.R_KZ).transpose();
  return {toEigen(state.p_0), Eigen::Quaterniond(R_0K).normalized()};
}

void checkSize(const char* name, Eigen::Index size, Eigen::Index expected) {
  if (size == expected) return;
  throw MotionError(std::string("motion: ") + name + " has " + std::to_string(size) +
                    " entries, the mechanism has " + std::to_string(expected) + " coordinates");
}

bool allFinite(const std::vector<Wrench>& wrenches) {
  for (const Wrench& wrench : wrenches) {
    if (!wrench.force.allFinite() || !wrench.torque.allFinite()) return false;
  }
  return true;
}

}  // namespace

InverseDynamics::InverseDynamics(const Mechanism& mechanism, const Scene& scene,
                                 const Request& request)
    : impl_(new Impl{request, roundPlan<double>(compilePlan(mechanism, scene, request))}) {}

InverseDynamics::InverseDynamics(const Mechanism& mechanism, const Scene& scene)
    : InverseDynamics(mechanism, scene, everything(mechanism, scene)) {}

InverseDynamics::~InverseDynamics() = default;
InverseDynamics::InverseDynamics(InverseDynamics&&) noexcept = default;
InverseDynamics& InverseDynamics::operator=(InverseDynamics&&) noexcept = default;

Eigen::Index InverseDynamics::coordinates() const {
  return impl_->plan.coordinates;
}

const Request& InverseDynamics::request() const {
  return impl_->request;
}

Workspace InverseDynamics::makeWorkspace() const {
  return Workspace(*impl_);
}

void InverseDynamics::compute(const Motion& motion, Workspace& workspace) const {
  const Plan<double>& plan = impl_->plan;
  checkSize("q", motion.q.size(), plan.coordinates);
  checkSize("qd", motion.qd.size(), plan.coordinates);
  checkSize("qdd", motion.qdd.size(), plan.coordinates);
  if (workspace.scratch_->plan != impl_.get()) {
    throw MotionError("the workspace belongs to another InverseDynamics");
  }
  auto& states = workspace.scratch_->states;

  sweepOut(plan, motion.q.data(), motion.qd.data(), motion.qdd.data(), states);
  subtractApplied(plan, workspace.scratch_->applied, states);
  sweepIn(plan, states, plan.efforts ? workspace.effort_.data() : nullptr);

  for (std::size_t i = 0; i < plan.child_axes.size(); ++i) {
    const auto& output = plan.child_axes[i];
    workspace.child_axes_[i] =
        toWrench(rotated(output.R_KZ, reported(plan, output, states[output.body])));
  }
  for (std::size_t i = 0; i < plan.root_axes.size(); ++i) {
    const auto& output = plan.root_axes[i];
    const BodyState<double>& state = states[output.body];
    workspace.root_axes_[i] =
        toWrench(rotated(state.R_0Z, reported(plan, output, state)));  // (4.3)
    if (!workspace.poses_.empty()) workspace.poses_[i] = poseOf(output, state);
    if (!workspace.twists_.empty()) {
      workspace.twists_[i] = {toEigen(state.R_0Z * state.v), toEigen(state.R_0Z * state.w)};
    }
  }
}

Workspace::Workspace(const InverseDynamics::Impl& impl)
    : effort_(Eigen::VectorXd::Zero(impl.request.efforts ? impl.plan.coordinates : 0)),
      child_axes_(impl.plan.child_axes.size()),
      root_axes_(impl.plan.root_axes.size()),
      poses_(impl.request.poses ? impl.plan.root_axes.size() : 0),
      twists_(impl.request.twists ? impl.plan.root_axes.size() : 0),
      scratch_(new Scratch) {
  scratch_->plan = &impl;
  scratch_->states.resize(impl.plan.bodies.size());
  scratch_->states[0].R_0Z = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (const auto& where : impl.plan.applied) {
    scratch_->applied.push_back(appliedValue(where, where.force, where.torque));
  }
}

Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

bool Workspace::finite() const {
  for (const Pose& pose : poses_) {
    if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) return false;
  }
  for (const Twist& twist : twists_) {
    if (!twist.linear.allFinite() || !twist.angular.allFinite()) return false;
  }
  return effort_.allFinite() && allFinite(child_axes_) && allFinite(root_axes_);
}

void Workspace::setAppliedWrench(std::size_t index, const Eigen::Vector3d& force,
                                 const Eigen::Vector3d& torque) {
  const auto& applied = scratch_->plan->plan.applied;
  if (index >= applied.size()) {
    throw SceneError("the scene has no applied wrench " + std::to_string(index));
  }
  scratch_->applied[index] = appliedValue(applied[index], plain(force), plain(torque));
}

}  // namespace virtual_work_dynamics
