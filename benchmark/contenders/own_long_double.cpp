#include "contenders/long_double_dynamics.h"
#include "contenders/offers.h"
#include "contenders/own_request.h"

namespace virtual_work_dynamics {
namespace {

/// What one sample costs where double does not suffice.
class OwnLongDouble : public Contender {
 public:
  OwnLongDouble(const BenchmarkScene& scene, const std::string& outputs)
      : dynamics_(scene.mechanism, ownScene(scene), ownRequest(scene, outputs)),
        coordinates_(scene.mechanism.coordinates().size()) {
    for (const Motion& motion : scene.motions) {
      for (const Eigen::VectorXd* values : {&motion.q, &motion.qd, &motion.qdd}) {
        inputs_.insert(inputs_.end(), values->data(), values->data() + values->size());
      }
    }
  }

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) {
      const long double* const q = inputs_.data() + 3 * cycle_.next() * coordinates_;
      dynamics_.compute(q, q + coordinates_, q + 2 * coordinates_);
    }
  }

  SampleResults results(std::size_t) const override {
    return {dynamics_.efforts(), dynamics_.childAxes()};
  }

 private:
  LongDoubleDynamics dynamics_;
  std::size_t coordinates_;
  std::vector<long double> inputs_;
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
