#include "contenders/completions.h"
#include "contenders/offers.h"
#include "contenders/own_request.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Efforts and reactions of motions that close the loops.
class OwnLoops : public Contender {
 public:
  OwnLoops(const BenchmarkScene& scene, const std::string& outputs)
      : motions_(scene.motions),
        dynamics_(scene.mechanism, *scene.loops, loopRequest(scene, outputs)),
        workspace_(dynamics_.makeWorkspace()) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) dynamics_.compute(motions_[cycle_.next()], workspace_);
  }

  SampleResults results(std::size_t) const override {
    return plainResults(workspace_.results().effort, workspace_.results().child_axes);
  }

 private:
  const std::vector<Motion>& motions_;
  Dynamics dynamics_;
  Dynamics::Workspace workspace_;
  StateCycle cycle_;
};

// Completes motions whose passive joints stand where they were a sample before, and computes
// efforts and reactions where wanted.
class OwnCompletion : public Contender {
 public:
  OwnCompletion(const BenchmarkScene& scene, const std::string& outputs)
      : starts_(startsOfCompletions(scene)),
        dynamics_(scene.mechanism, *scene.loops, loopRequest(scene, outputs)),
        workspace_(dynamics_.makeWorkspace()),
        computes_(outputs != kCompletedMotion) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) {
      motion_ = starts_[cycle_.next()];
      closes_ = dynamics_.complete(motion_, workspace_) && closes_;
      if (computes_) dynamics_.compute(motion_, workspace_);
    }
  }

  SampleResults results(std::size_t) const override {
    if (!closes_) throw Error("does not close the loops");
    if (computes_)
      return plainResults(workspace_.results().effort, workspace_.results().child_axes);
    return resultsOf(motion_);
  }

 private:
  std::vector<Motion> starts_;
  Dynamics dynamics_;
  Dynamics::Workspace workspace_;
  bool computes_;
  bool closes_ = true;
  Motion motion_;
  StateCycle cycle_;
};

}  // namespace

void offerOwnLoops(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    offers.push_back({{"virtual_work", "double", "single", outputs, 1},
                      [&scene, outputs] { return std::make_unique<OwnLoops>(scene, outputs); }});
  }
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    offers.push_back({{"virtual_work", "double", "completed", outputs, 1}, [&scene, outputs] {
                        return std::make_unique<OwnCompletion>(scene, outputs);
                      }});
  }
  offers.push_back({{"virtual_work", "double", "completion", kCompletedMotion, 1},
                    [&scene] { return std::make_unique<OwnCompletion>(scene, kCompletedMotion); }});
}

}  // namespace virtual_work_dynamics
