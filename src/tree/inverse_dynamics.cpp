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
static_assert(sizeof(Eigen::Quaterniond) == 4 * sizeof(double), "x y z w");
static_assert(sizeof(Twist) == 6 * sizeof(double), "linear, then angular");
constexpr std::size_t kPoseNumbers = 12;

struct Workspace::Scratch {
  explicit Scratch(const InverseDynamics::Impl& impl)
      : plan(&impl),
        own(impl.plan),
        given(impl.plan),
        memory(impl.kernel->scratchSize(impl.view)),
        unturned(static_cast<std::size_t>(impl.plan.orientations), Eigen::Quaterniond::Identity()),
        poses(impl.request.poses ? kPoseNumbers * impl.plan.root_axes.size() : 0) {
    impl.kernel->prepare(impl.view, memory.get());
  }

  const InverseDynamics::Impl* plan;  // is compared, never read
  AppliedValues<double> own;          // values of the scene's applied wrenches
  AppliedValues<double> given;        // values of a Load's wrenches
  AlignedMemory memory;
  std::vector<Eigen::Quaterniond> unturned;  // orientations of motions that have none
  std::vector<double> poses;
  RootState root{RootMotion(), Eigen::Vector3d::Zero(), true};
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

// Where numbers are written; null when there are none.
template <typename Item>
double* numbersOf(std::vector<Item>& items) {
  return items.empty() ? nullptr : reinterpret_cast<double*>(items.data());
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

std::size_t InverseDynamics::orientations() const {
  return static_cast<std::size_t>(impl_->plan.orientations);
}

Eigen::Index InverseDynamics::coordinates() const {
  return impl_->plan.coordinates;
}

const Request& InverseDynamics::request() const {
  return impl_->request;
}

InstructionSet InverseDynamics::instructionSet() const {
  return impl_->instruction_set;
}

bool InverseDynamics::rootMoves() const {
  return impl_->plan.root_moves;
}

RootState InverseDynamics::rootState(const RootMotion& motion) const {
  const Plan<double>& plan = impl_->plan;
  return RootState(motion, Eigen::Vector3d(plan.gravity), plan.static_motion);
}

PlanSummary InverseDynamics::summary() const {
  return summarize(impl_->plan);
}

Workspace InverseDynamics::makeWorkspace() const {
  return Workspace(*impl_);
}

void InverseDynamics::compute(const Motion& motion, Workspace& workspace) const {
  computeWith(nullptr, motion, workspace);
}

void InverseDynamics::compute(const Motion& motion, const Load& load, Workspace& workspace) const {
  computeWith(&load, motion, workspace);
}

void InverseDynamics::computeWith(const Load* load, const Motion& motion,
                                  Workspace& workspace) const {
  const Plan<double>& plan = impl_->plan;
  requireLengths(motion, plan.coordinates);
  workspace.requirePlan(impl_.get());
  Workspace::Scratch& scratch = *workspace.scratch_;
  Results& results = workspace.results_;
  if (load) scratch.given.set(plan, *load);
  const AppliedValues<double>& applied = load ? scratch.given : scratch.own;
  KernelInputs<double> in = {motion.q.data(), motion.qd.data(), motion.qdd.data(), 1,
                             applied.data(),  applied.stride()};
  if (plan.root_moves) {
    scratch.root = rootState(motion.root);
    in.root = scratch.root.data();
    in.root_stride = 1;
  }
  if (plan.orientations > 0) {
    requireOrientations(motion, static_cast<std::size_t>(plan.orientations));
    const auto& all = motion.orientations.empty() ? scratch.unturned : motion.orientations;
    in.orientations = all.front().coeffs().data();
    in.orientation_stride = 1;
  }
  const KernelOutputs<double> out = {plan.efforts ? results.effort.data() : nullptr,
                                     numbersOf(results.child_axes),
                                     numbersOf(results.root_axes),
                                     numbersOf(scratch.poses),
                                     numbersOf(results.twists),
                                     1};
  impl_->kernel->one(impl_->view, in, out, scratch.memory.get());
  for (std::size_t i = 0; i < results.poses.size(); ++i) {
    results.poses[i] = poseOf(scratch.poses.data() + kPoseNumbers * i);
  }
}

Workspace::Workspace(const InverseDynamics::Impl& impl) : scratch_(new Scratch(impl)) {
  results_.effort.setZero(impl.request.efforts ? impl.plan.coordinates : 0);
  results_.child_axes.resize(impl.plan.child_axes.size());
  results_.root_axes.resize(impl.plan.root_axes.size());
  results_.poses.resize(impl.request.poses ? impl.plan.root_axes.size() : 0);
  results_.twists.resize(impl.request.twists ? impl.plan.root_axes.size() : 0);
}

void Workspace::requirePlan(const InverseDynamics::Impl* plan) const {
  if (scratch_->plan != plan) throw MotionError("the workspace belongs to another InverseDynamics");
}

void Workspace::assign(const double* effort, const double* child_axes, const double* root_axes,
                       const double* poses, const double* twists) {
  Results& to = results_;
  std::copy(effort, effort + to.effort.size(), to.effort.data());
  std::copy(child_axes, child_axes + 6 * to.child_axes.size(), numbersOf(to.child_axes));
  std::copy(root_axes, root_axes + 6 * to.root_axes.size(), numbersOf(to.root_axes));
  std::copy(twists, twists + 6 * to.twists.size(), numbersOf(to.twists));
  for (std::size_t i = 0; i < to.poses.size(); ++i) {
    to.poses[i] = poseOf(poses + kPoseNumbers * i);
  }
}

Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

}  // namespace virtual_work_dynamics
