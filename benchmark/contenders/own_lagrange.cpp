#include "contenders/offers.h"
#include "contenders/own_request.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

/// The paper's other formalism, one sample after another.
template <typename Real>
class OwnLagrange : public Contender {
 public:
  OwnLagrange(const BenchmarkScene& scene, const std::string& outputs)
      : motions_(scene.motions),
        lagrange_(scene.mechanism, ownScene(scene), ownRequest(scene, outputs)) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) lagrange_.compute(motions_[cycle_.next()]);
  }

  SampleResults results(std::size_t) const override {
    return plainResults(lagrange_.effort(), lagrange_.childAxes());
  }

 private:
  const std::vector<Motion>& motions_;
  LagrangeDynamics<Real> lagrange_;
  StateCycle cycle_;
};

template <typename Real>
void offer(const char* precision, const BenchmarkScene& scene, std::vector<Offer>& offers) {
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    const Label label{"lagrange", precision, "single", outputs, 1};
    offers.push_back(
        {label, [&scene, outputs] { return std::make_unique<OwnLagrange<Real>>(scene, outputs); }});
  }
}

}  // namespace

void offerOwnLagrange(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  // Its cost grows with the square of the number of joints: a thousand would take minutes.
  constexpr std::size_t kMostJoints = 100;
  if (movableJoints(scene.mechanism).size() > kMostJoints) return;
  offer<double>("double", scene, offers);
  offer<long double>("long_double", scene, offers);
}

}  // namespace virtual_work_dynamics
