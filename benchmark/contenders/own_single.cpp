#include "contenders/offers.h"
#include "contenders/own_request.h"

namespace virtual_work_dynamics {
namespace {

class OwnSingle : public Contender {
 public:
  OwnSingle(const BenchmarkScene& scene, const std::string& outputs)
      : motions_(scene.motions),
        inverse_dynamics_(scene.mechanism, ownScene(scene), ownRequest(scene, outputs)),
        workspace_(inverse_dynamics_.makeWorkspace()) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) inverse_dynamics_.compute(motions_[cycle_.next()], workspace_);
  }

  SampleResults results(std::size_t) const override {
    return plainResults(workspace_.effort(), workspace_.childAxes());
  }

 private:
  const std::vector<Motion>& motions_;
  InverseDynamics inverse_dynamics_;
  Workspace workspace_;
  StateCycle cycle_;
};

}  // namespace

void offerOwnSingle(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    const Label label{"virtual_work", "double", "single", outputs, 1};
    offers.push_back(
        {label, [&scene, outputs] { return std::make_unique<OwnSingle>(scene, outputs); }});
  }
}

}  // namespace virtual_work_dynamics
