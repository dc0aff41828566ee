#include <cmath>

#include "core/aligned_memory.h"
#include "core/kernel/joint_angles.h"
#include "core/kernel/scratch.h"
#include "core/plan.h"
#include "offers.h"
#include "own_request.h"

namespace virtual_work_dynamics {
namespace {

using Real = long double;

Real sineOf(Real angle) {
  return std::sin(angle);
}
Real cosineOf(Real angle) {
  return std::cos(angle);
}

/// The recursion itself, on long double: what one sample costs where double does not suffice.
class OwnLongDouble : public Contender {
 public:
  OwnLongDouble(const BenchmarkScene& scene, const std::string& outputs)
      : plan_(compilePlan(scene.mechanism, ownScene(scene), ownRequest(scene, outputs))),
        view_(viewOf(plan_)),
        memory_(sizeOf(view_)),
        scratch_(scratchIn(view_, memory_)),
        effort_(static_cast<std::size_t>(plan_.coordinates)),
        reactions_(6 * plan_.child_axes.size()) {
    prepareScratch(view_, 0, scratch_);
    for (const Motion& motion : scene.motions) {
      for (const Eigen::VectorXd* values : {&motion.q, &motion.qd, &motion.qdd}) {
        inputs_.insert(inputs_.end(), values->data(), values->data() + values->size());
      }
    }
  }

  void run(std::size_t calls) override {
    const KernelOutputs<Real> out = {
        effort_.data(), reactions_.empty() ? nullptr : reactions_.data(),
        nullptr,        nullptr,
        nullptr,        1};
    for (; calls > 0; --calls) {
      const Real* const q = inputs_.data() + 3 * cycle_.next() * effort_.size();
      const KernelInputs<Real> in = {q, q + effort_.size(), q + 2 * effort_.size(), 1, nullptr};
      plainAngles(view_, in, scratch_, sineOf, cosineOf);
      evaluate(view_, in, out, scratch_);
    }
  }

  SampleResults results(std::size_t) const override { return {effort_, reactions_}; }

 private:
  static std::size_t sizeOf(const PlanView<Real>& view) {
    ScratchDealer dealer(nullptr);
    dealScratch<Real>(view, 0, dealer);
    return dealer.used();
  }

  static Scratch<Real, Real> scratchIn(const PlanView<Real>& view, const AlignedMemory& memory) {
    ScratchDealer dealer(memory.get());
    return dealScratch<Real>(view, 0, dealer);
  }

  Plan<Real> plan_;
  PlanView<Real> view_;
  AlignedMemory memory_;
  Scratch<Real, Real> scratch_;
  std::vector<Real> inputs_, effort_, reactions_;
  StateCycle cycle_;
};

}  // namespace

void offerOwnLongDouble(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    const Label label{"virtual_work", "long_double", "single", outputs, 1};
    offers.push_back(
        {label, [&scene, outputs] { return std::make_unique<OwnLongDouble>(scene, outputs); }});
  }
}

}  // namespace virtual_work_dynamics
