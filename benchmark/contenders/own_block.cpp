#include "contenders/offers.h"
#include "contenders/own_request.h"
#include "virtual_work_dynamics/block.h"

namespace virtual_work_dynamics {
namespace {

// Arrays of a block stay in a core's second-level cache: fewer samples for long chains, down to the
// widest vector's. Counts are odd multiples of the states: see BlockLayout on powers of two.
constexpr std::size_t kMostRounds = 63;
constexpr std::size_t kCacheBytes = std::size_t(1) << 20;
// Starting threads takes microseconds: they are for long blocks.
constexpr std::size_t kLongerForThreads = 4;

template <typename Real>
std::size_t samplesOf(std::size_t numbers_in_sample, int threads) {
  std::size_t rounds = kMostRounds;
  while (rounds > 1 && rounds * kStates * numbers_in_sample * sizeof(Real) > kCacheBytes) {
    rounds = (rounds - 1) / 2;
  }
  const std::size_t samples = rounds * kStates * static_cast<std::size_t>(threads);
  return threads > 1 ? kLongerForThreads * samples : samples;
}

// One array of `width` numbers for each sample in the given layout.
template <typename Real>
class Array {
 public:
  Array(BlockLayout layout, std::size_t samples, std::size_t width)
      : layout_(layout), samples_(samples), width_(width), numbers_(samples * width) {}

  Real& at(std::size_t sample, std::size_t number) { return numbers_[place(sample, number)]; }
  Real at(std::size_t sample, std::size_t number) const { return numbers_[place(sample, number)]; }
  std::size_t width() const { return width_; }
  Real* data() { return numbers_.data(); }

 private:
  std::size_t place(std::size_t sample, std::size_t number) const {
    return layout_ == BlockLayout::kRowMajor ? sample * width_ + number
                                             : number * samples_ + sample;
  }

  BlockLayout layout_;
  std::size_t samples_, width_;
  std::vector<Real> numbers_;
};

template <typename Real>
Array<Real> arrayOf(const BenchmarkScene& scene, Eigen::VectorXd Motion::*member,
                    BlockLayout layout, std::size_t samples) {
  Array<Real> array(layout, samples, scene.mechanism.coordinates().size());
  for (std::size_t n = 0; n < samples; ++n) {
    const Eigen::VectorXd& values = scene.motions[n % kStates].*member;
    for (std::size_t i = 0; i < array.width(); ++i) {
      array.at(n, i) = static_cast<Real>(values[static_cast<Eigen::Index>(i)]);
    }
  }
  return array;
}

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
    SampleResults results;
    for (std::size_t i = 0; i < effort_.width(); ++i) {
      results.efforts.push_back(effort_.at(sample, i));
    }
    for (std::size_t i = 0; i < reactions_.width(); ++i) {
      results.reactions.push_back(reactions_.at(sample, i));
    }
    return results;
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
