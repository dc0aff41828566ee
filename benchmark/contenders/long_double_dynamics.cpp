#include "contenders/long_double_dynamics.h"

#include <cmath>

#include "base/aligned_memory.h"
#include "tree/kernel/joint_angles.h"
#include "tree/kernel/scratch.h"
#include "tree/plan.h"

namespace virtual_work_dynamics {
namespace {

using Real = long double;

Real sineOf(Real angle) {
  return std::sin(angle);
}
Real cosineOf(Real angle) {
  return std::cos(angle);
}

std::size_t sizeOf(const PlanView<Real>& view) {
  ScratchDealer dealer(nullptr);
  dealScratch<Real>(view, 0, dealer);
  return dealer.used();
}

Scratch<Real, Real> scratchIn(const PlanView<Real>& view, const AlignedMemory& memory) {
  ScratchDealer dealer(memory.get());
  return dealScratch<Real>(view, 0, dealer);
}

Real* orNull(std::vector<Real>& numbers) {
  return numbers.empty() ? nullptr : numbers.data();
}

}  // namespace

struct LongDoubleDynamics::Impl {
  explicit Impl(Plan<Real> compiled)
      : plan(std::move(compiled)),
        view(viewOf(plan)),
        memory(sizeOf(view)),
        scratch(scratchIn(view, memory)),
        efforts(static_cast<std::size_t>(plan.efforts ? plan.coordinates : 0)),
        child_axes(6 * plan.child_axes.size()),
        root_axes(6 * plan.root_axes.size()) {
    prepareScratch(view, 0, scratch);
  }

  Plan<Real> plan;
  PlanView<Real> view;
  AlignedMemory memory;
  Scratch<Real, Real> scratch;
  std::vector<Real> efforts, child_axes, root_axes;
};

LongDoubleDynamics::LongDoubleDynamics(const Mechanism& mechanism, const Scene& scene,
                                       const Request& request)
    : impl_(new Impl(compilePlan(mechanism, scene, request))) {}

LongDoubleDynamics::~LongDoubleDynamics() = default;
LongDoubleDynamics::LongDoubleDynamics(LongDoubleDynamics&&) noexcept = default;

void LongDoubleDynamics::compute(const Real* q, const Real* qd, const Real* qdd) {
  Impl& impl = *impl_;
  const KernelInputs<Real> in = {q, qd, qdd, 1, nullptr, 0};
  const KernelOutputs<Real> out = {
      orNull(impl.efforts), orNull(impl.child_axes), orNull(impl.root_axes), nullptr, nullptr, 1};
  plainAngles(impl.view, in, impl.scratch, sineOf, cosineOf);
  evaluate(impl.view, in, out, impl.scratch);
}

const std::vector<Real>& LongDoubleDynamics::efforts() const {
  return impl_->efforts;
}
const std::vector<Real>& LongDoubleDynamics::childAxes() const {
  return impl_->child_axes;
}
const std::vector<Real>& LongDoubleDynamics::rootAxes() const {
  return impl_->root_axes;
}

}  // namespace virtual_work_dynamics
