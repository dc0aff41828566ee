#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "contenders/contender.h"
#include "virtual_work_dynamics/error.h"

// Computes samples in a function that valgrind can be told to count; see
// scripts/count_instructions.sh.

namespace virtual_work_dynamics {
namespace {

constexpr char kUsage[] =
    R"(callgrind_sample: computes samples of one contender, for counting instructions

  callgrind_sample SCENE                  lists contenders: method,precision,mode,outputs
  callgrind_sample SCENE CONTENDER COUNT  computes at least COUNT samples of one of them inside the
                                          function countedRun, and prints how many
)";

std::string lineOf(const Label& label) {
  return label.method + ',' + label.precision + ',' + label.mode + ',' + label.outputs;
}

std::unique_ptr<Contender> makeContender(const BenchmarkScene& scene, const std::string& line) {
  for (const Offer& offer : offersFor(scene)) {
    if (offer.label.threads == 1 && lineOf(offer.label) == line) return offer.make();
  }
  throw Error(scene.name + ": there is no contender '" + line + "'");
}

int listContenders(const BenchmarkScene& scene) {
  for (const Offer& offer : offersFor(scene)) {
    if (offer.label.threads == 1) std::printf("%s\n", lineOf(offer.label).c_str());
  }
  return 0;
}

}  // namespace
}  // namespace virtual_work_dynamics

extern "C" __attribute__((noinline)) void countedRun(virtual_work_dynamics::Contender* contender,
                                                     std::size_t calls) {
  contender->run(calls);
}

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  if (argc == 2 && argv[1] == std::string("--help")) {
    std::printf("%s", kUsage);
    return 0;
  }
  const long count = argc == 4 ? std::atol(argv[3]) : 0;
  if (argc != 2 && (argc != 4 || count < 1)) {
    std::fprintf(stderr, "%s", kUsage);
    return 2;
  }
  try {
    const BenchmarkScene scene = makeScene(argv[1]);
    if (argc == 2) return listContenders(scene);
    const std::unique_ptr<Contender> contender = makeContender(scene, argv[2]);
    const std::size_t per_call = contender->samplesPerCall();
    const std::size_t calls = (static_cast<std::size_t>(count) + per_call - 1) / per_call;
    contender->run(1);  // what happens only once, as looking up library functions
    countedRun(contender.get(), calls);
    std::printf("%zu\n", calls * per_call);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "callgrind_sample: %s\n", error.what());
    return 1;
  }
}
