#include "contenders/offers.h"
#include "contenders/own_arrays.h"
#include "contenders/own_request.h"
#include "virtual_work_dynamics/block.h"

namespace virtual_work_dynamics {
namespace {

template <typename Real>
class OwnBlock : public Contender {
 public:
  OwnBlock(const BenchmarkScene& scene, const std::string& outputs, BlockLayout layout,
           InstructionSet instruction_set, int threads)
      : OwnBlock(scene, ownRequest(scene, outputs), layout, instruction_set, threads) {}

  std::size_t samplesPerCall() const override { return motion_.samples; }

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) dynamics_.compute(layout_, motion_, results_);
  }

  SampleResults results(std::size_t sample) const override {
    return resultsOf(effort_, reactions_, sample);
  }

 private:
  OwnBlock(const BenchmarkScene& scene, const Request& request, BlockLayout layout,
           InstructionSet instruction_set, int threads)
      : OwnBlock(scene, request, layout, instruction_set, threads,
                 samplesOf<Real>(
                     4 * scene.mechanism.coordinates().size() + 6 * request.child_axes.size(),
                     threads)) {}

  OwnBlock(const BenchmarkScene& scene, const Request& request, BlockLayout layout,
           InstructionSet instruction_set, int threads, std::size_t samples)
      : layout_(layout),
        dynamics_(InverseDynamics(scene.mechanism, ownScene(scene), request), threads,
                  instruction_set),
        q_(arrayOf<Real>(scene, &Motion::q, layout, samples)),
        qd_(arrayOf<Real>(scene, &Motion::qd, layout, samples)),
        qdd_(arrayOf<Real>(scene, &Motion::qdd, layout, samples)),
        effort_(layout, samples, scene.mechanism.coordinates().size()),
        reactions_(layout, samples, 6 * request.child_axes.size()) {
    motion_.samples = samples;
    motion_.q = q_.data();
    motion_.qd = qd_.data();
    motion_.qdd = qdd_.data();
    results_.effort = effort_.data();
    if (reactions_.width() > 0) results_.child_axes = reactions_.data();
  }

  BlockLayout layout_;
  BlockInverseDynamics<Real> dynamics_;
  Array<Real> q_, qd_, qdd_, effort_, reactions_;
  MotionBlock<Real> motion_;
  ResultBlock<Real> results_;
};

template <typename Real>
void offerPrecision(const BenchmarkScene& scene, const char* precision,
                    std::vector<Offer>& offers) {
  for (const BlockLayout layout : {BlockLayout::kStructureOfArrays, BlockLayout::kRowMajor}) {
    const std::string mode = layout == BlockLayout::kRowMajor ? "block_rows_" : "block_soa_";
    for (const InstructionSet instruction_set :
         {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
      if (!isSupported(instruction_set)) continue;
      for (const int threads : {1, 2}) {
        for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
          const Label label{"virtual_work", precision, mode + toString(instruction_set), outputs,
                            threads};
          offers.push_back({label, [=, &scene] {
                              return std::make_unique<OwnBlock<Real>>(scene, outputs, layout,
                                                                      instruction_set, threads);
                            }});
        }
      }
    }
  }
}

}  // namespace

void offerOwnBlocks(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  offerPrecision<double>(scene, "double", offers);
  offerPrecision<float>(scene, "float", offers);
}

}  // namespace virtual_work_dynamics
