#include "contenders/completions.h"
#include "contenders/dense_linkage.h"
#include "contenders/offers.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

class DenseEfforts : public Contender {
 public:
  explicit DenseEfforts(const BenchmarkScene& scene)
      : motions_(scene.motions), linkage_(scene), efforts_(motions_[0].q.size()) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) linkage_.computeEfforts(motions_[cycle_.next()], efforts_);
  }

  SampleResults results(std::size_t) const override {
    SampleResults results;
    results.efforts.assign(efforts_.data(), efforts_.data() + efforts_.size());
    return results;
  }

 private:
  const std::vector<Motion>& motions_;
  DenseLinkage linkage_;
  Eigen::VectorXd efforts_;
  StateCycle cycle_;
};

class DenseCompletion : public Contender {
 public:
  explicit DenseCompletion(const BenchmarkScene& scene)
      : starts_(startsOfCompletions(scene)), linkage_(scene) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) {
      motion_ = starts_[cycle_.next()];
      closes_ = linkage_.complete(motion_) && closes_;
    }
  }

  SampleResults results(std::size_t) const override {
    if (!closes_) throw Error("does not close the loops");
    return resultsOf(motion_);
  }

 private:
  std::vector<Motion> starts_;
  DenseLinkage linkage_;
  bool closes_ = true;
  Motion motion_;
  StateCycle cycle_;
};

}  // namespace

void offerDenseLoops(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  constexpr std::size_t kMostJoints = 30;  // cost grows with the cube of their number
  if (scene.mechanism.joints().size() > kMostJoints || !DenseLinkage::canCompute(scene)) return;
  offers.push_back({{"dense", "double", "single", kEfforts, 1},
                    [&scene] { return std::make_unique<DenseEfforts>(scene); }});
  offers.push_back({{"dense", "double", "completion", kCompletedMotion, 1},
                    [&scene] { return std::make_unique<DenseCompletion>(scene); }});
}

}  // namespace virtual_work_dynamics
