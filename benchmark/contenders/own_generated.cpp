#include <map>
#include <memory>
#include <utility>

#include "contenders/built_library.h"
#include "contenders/offers.h"
#include "contenders/own_arrays.h"
#include "contenders/own_request.h"
#include "virtual_work_dynamics/generated_code.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kName[] = "generated";
// From some 60 joints on a sample takes longer than by the plan; of 100 the source has 2.2 MB.
constexpr std::size_t kMostJoints = 100;

// One sample and blocks are functions of one library, which is built once.
std::shared_ptr<const BuiltLibrary> libraryOf(const BenchmarkScene& scene,
                                              const std::string& outputs, const Request& request) {
  static std::map<std::pair<std::string, std::string>, std::weak_ptr<const BuiltLibrary>> all;
  std::weak_ptr<const BuiltLibrary>& kept = all[{scene.name, outputs}];
  std::shared_ptr<const BuiltLibrary> library = kept.lock();
  if (library) return library;
  GeneratedCodeOptions options;
  options.name = kName;
  library = std::make_shared<const BuiltLibrary>(
      kName, generateCode(scene.mechanism, ownScene(scene), request, options),
      chosenInstructionSet());
  kept = library;
  return library;
}

// The reactions are an argument where they are asked for.
template <typename Function>
Function functionOf(const BuiltLibrary& library, const char* name) {
  return reinterpret_cast<Function>(library.function(name));
}

class GeneratedSingle : public Contender {
 public:
  GeneratedSingle(const BenchmarkScene& scene, const std::string& outputs)
      : motions_(scene.motions),
        request_(ownRequest(scene, outputs)),
        library_(libraryOf(scene, outputs, request_)),
        efforts_(functionOf<Efforts>(*library_, "generated_compute")),
        everything_(functionOf<Everything>(*library_, "generated_compute")),
        effort_(Eigen::VectorXd::Zero(motions_[0].q.size())),
        reactions_(request_.child_axes.size()) {}

  void run(std::size_t calls) override {
    if (reactions_.empty()) {
      for (; calls > 0; --calls) {
        const Motion& motion = motions_[cycle_.next()];
        efforts_(motion.q.data(), motion.qd.data(), motion.qdd.data(), effort_.data());
      }
    } else {
      for (; calls > 0; --calls) {
        const Motion& motion = motions_[cycle_.next()];
        everything_(motion.q.data(), motion.qd.data(), motion.qdd.data(), effort_.data(),
                    reactions_[0].force.data());
      }
    }
  }

  SampleResults results(std::size_t) const override { return plainResults(effort_, reactions_); }

 private:
  using Efforts = void (*)(const double*, const double*, const double*, double*);
  using Everything = void (*)(const double*, const double*, const double*, double*, double*);

  const std::vector<Motion>& motions_;
  const Request request_;
  const std::shared_ptr<const BuiltLibrary> library_;
  const Efforts efforts_;
  const Everything everything_;
  Eigen::VectorXd effort_;
  std::vector<Wrench> reactions_;
  StateCycle cycle_;
};

class GeneratedBlock : public Contender {
 public:
  GeneratedBlock(const BenchmarkScene& scene, const std::string& outputs)
      : GeneratedBlock(scene, outputs, ownRequest(scene, outputs)) {}

  std::size_t samplesPerCall() const override { return samples_; }

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) {
      if (reactions_.width() == 0) {
        efforts_(samples_, samples_, q_.data(), qd_.data(), qdd_.data(), effort_.data());
      } else {
        everything_(samples_, samples_, q_.data(), qd_.data(), qdd_.data(), effort_.data(),
                    reactions_.data());
      }
    }
  }

  SampleResults results(std::size_t sample) const override {
    return resultsOf(effort_, reactions_, sample);
  }

 private:
  using Efforts = void (*)(std::size_t, std::size_t, const double*, const double*, const double*,
                           double*);
  using Everything = void (*)(std::size_t, std::size_t, const double*, const double*, const double*,
                              double*, double*);
  static constexpr BlockLayout kLayout = BlockLayout::kStructureOfArrays;

  GeneratedBlock(const BenchmarkScene& scene, const std::string& outputs, const Request& request)
      : samples_(samplesOf<double>(
            4 * scene.mechanism.coordinates().size() + 6 * request.child_axes.size(), 1)),
        library_(libraryOf(scene, outputs, request)),
        efforts_(functionOf<Efforts>(*library_, "generated_compute_block")),
        everything_(functionOf<Everything>(*library_, "generated_compute_block")),
        q_(arrayOf<double>(scene, &Motion::q, kLayout, samples_)),
        qd_(arrayOf<double>(scene, &Motion::qd, kLayout, samples_)),
        qdd_(arrayOf<double>(scene, &Motion::qdd, kLayout, samples_)),
        effort_(kLayout, samples_, scene.mechanism.coordinates().size()),
        reactions_(kLayout, samples_, 6 * request.child_axes.size()) {}

  const std::size_t samples_;
  const std::shared_ptr<const BuiltLibrary> library_;
  const Efforts efforts_;
  const Everything everything_;
  Array<double> q_, qd_, qdd_, effort_, reactions_;
};

}  // namespace

void offerGenerated(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  if (scene.mechanism.coordinates().size() > kMostJoints) return;
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    const Label label{"generated", "double", "single", outputs, 1};
    offers.push_back(
        {label, [&scene, outputs] { return std::make_unique<GeneratedSingle>(scene, outputs); }});
  }
  const std::string mode = "block_soa_" + toString(chosenInstructionSet());
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    const Label label{"generated", "double", mode, outputs, 1};
    offers.push_back(
        {label, [&scene, outputs] { return std::make_unique<GeneratedBlock>(scene, outputs); }});
  }
}

}  // namespace virtual_work_dynamics
