#include "virtual_work_dynamics/inverse_dynamics.h"

#include <algorithm>
#include <utility>

#include "base/aligned_memory.h"
#include "scene/input_checks.h"
#include "tree/applied_values.h"
#include "tree/compiled_plan.h"
#include "tree/plan_counting.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

// Results are written as plain numbers in this order.
static_assert(sizeof(Wrench) == 6 * sizeof(double), "force, then torque");
static_assert(sizeof(Twist) == 6 * sizeof(double), "linear, then angular");
constexpr std::size_t kPoseNumbers = 12;

struct Workspace::Scratch {
  explicit Scratch(const InverseDynamics::Impl& impl)
      : plan(&impl),
        applied(impl.plan),
        memory(impl.kernel->scratchSize(impl.view)),
        poses(impl.request.poses ? kPoseNumbers * impl.plan.root_axes.size() : 0) {
    impl.kernel->prepare(impl.view, memory.get());
  }

  const InverseDynamics::Impl* plan;  // only compared, and asked where applied wrenches act
  AppliedValues<double> applied;
  AlignedMemory memory;
  std::vector<double> poses;
};

namespace {

Request everything(const Mechanism& mechanism, const Scene& scene) {
  Request request;
  request.child_axes = requestedReactions(mechanism, scene);
  request.root_axes = request.child_axes;
  return request;
}

Pose poseOf(const double* numbers) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Matrix3d R_0K = Eigen::Map<const RowMajor>(numbers + 3);
  return {Eigen::Map<const Eigen::Vector3d>(numbers), Eigen::Quaterniond(R_0K).normalized()};
}

// Null when there is nothing to write.
template <typename Item>
double* numbersOf(std::vector<Item>& items) {
  return items.empty() ? nullptr : reinterpret_cast<double*>(items.data());
}

bool allFinite(const std::vector<Wrench>& wrenches) {
  for (const Wrench& wrench : wrenches) {
    if (!wrench.force.allFinite() || !wrench.torque.allFinite()) return false;
  }
  return true;
}

}  // namespace

InverseDynamics::InverseDynamics(const Mechanism& mechanism, const Scene& scene,
                                 const Request& request, InstructionSet instruction_set)
    : impl_(new Impl(mechanism, scene, request, instruction_set)) {}

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

InstructionSet InverseDynamics::instructionSet() const {
  return impl_->instruction_set;
}

PlanSummary InverseDynamics::summary() const {
  return summarize(impl_->plan);
}

Workspace InverseDynamics::makeWorkspace() const {
  return Workspace(*impl_);
}

void InverseDynamics::compute(const Motion& motion, Workspace& workspace) const {
  const Plan<double>& plan = impl_->plan;
  requireLengths(motion, plan.coordinates);
  workspace.requirePlan(impl_.get());
  Workspace::Scratch& scratch = *workspace.scratch_;
  const KernelInputs<double> in = {motion.q.data(), motion.qd.data(), motion.qdd.data(), 1,
                                   scratch.applied.data()};
  const KernelOutputs<double> out = {plan.efforts ? workspace.effort_.data() : nullptr,
                                     numbersOf(workspace.child_axes_),
                                     numbersOf(workspace.root_axes_),
                                     numbersOf(scratch.poses),
                                     numbersOf(workspace.twists_),
                                     1};
  impl_->kernel->one(impl_->view, in, out, scratch.memory.get());
  for (std::size_t i = 0; i < workspace.poses_.size(); ++i) {
    workspace.poses_[i] = poseOf(scratch.poses.data() + kPoseNumbers * i);
  }
}

Workspace::Workspace(const InverseDynamics::Impl& impl)
    : effort_(Eigen::VectorXd::Zero(impl.request.efforts ? impl.plan.coordinates : 0)),
      child_axes_(impl.plan.child_axes.size()),
      root_axes_(impl.plan.root_axes.size()),
      poses_(impl.request.poses ? impl.plan.root_axes.size() : 0),
      twists_(impl.request.twists ? impl.plan.root_axes.size() : 0),
      scratch_(new Scratch(impl)) {}

void Workspace::requirePlan(const InverseDynamics::Impl* plan) const {
  if (scratch_->plan != plan) throw MotionError("the workspace belongs to another InverseDynamics");
}

void Workspace::assign(const double* effort, const double* child_axes, const double* root_axes,
                       const double* poses, const double* twists) {
  std::copy(effort, effort + effort_.size(), effort_.data());
  std::copy(child_axes, child_axes + 6 * child_axes_.size(), numbersOf(child_axes_));
  std::copy(root_axes, root_axes + 6 * root_axes_.size(), numbersOf(root_axes_));
  std::copy(twists, twists + 6 * twists_.size(), numbersOf(twists_));
  for (std::size_t i = 0; i < poses_.size(); ++i) poses_[i] = poseOf(poses + kPoseNumbers * i);
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
  scratch_->applied.set(scratch_->plan->plan, index, force, torque);
}

}  // namespace virtual_work_dynamics
