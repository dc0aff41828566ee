#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "command_line.h"
#include "stability/loop_scenes.h"

namespace virtual_work_dynamics {
namespace {

const char kHelp[] =
    R"(Usage: structured_loops [--scenes N] [--seed S] [--first I] [--threads N] [--mixed]

Computes random mechanisms with closed loops in which much is special (frames of closures on axes of
joints, parallel and intersecting axes, copies of closures, sizes from 1e-6 to 1e6 m, masses from
1e-12 to 1e12 kg) and compares efforts, reactions, ranks and flags with the equations of all joints,
solved in 64 bits by Gauss with full pivoting. Prints a line for each scene that is not right, then
the sums. Errors are judged as by `stability`: over 4 (L + n) eps condition S.
  --scenes   number of scenes (1000)
  --seed     of the scenes (1)
  --first    number of the first scene, so that one that is wrong can be repeated alone (1)
  --threads  (as many as there are processors)
  --mixed    all kinds of conditions in one mechanism: wheels, blades, contacts, cylinders, gears,
             racks and couplings, too, with roots that move, payloads and free motions
Exit status: 0 all right, 1 some are wrong or something failed, 2 wrong usage.
)";

constexpr std::size_t kMostLines = 50;

struct Options {
  int scenes = 1000, seed = 1, first = 1, threads = 0;
  bool mixed = false;
};

SceneVerdict judgeAll(const Options& options) {
  const auto count = static_cast<std::size_t>(options.scenes);
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // of what follows
  SceneVerdict sum;
  std::size_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      const std::size_t index = static_cast<std::size_t>(options.first) + i;
      SceneVerdict verdict;
      try {
        const auto seed = static_cast<std::uint32_t>(options.seed);
        verdict = options.mixed ? judgeMixedScene(seed, index) : judgeScene(seed, index);
      } catch (const std::exception& error) {
        verdict.scenes = 1;
        verdict.wrong.push_back("scene " + std::to_string(index) + ": " + error.what());
      }
      const std::lock_guard<std::mutex> lock(mutex);
      sum.include(verdict);
      showProgress("scenes", ++done, count);
    }
  };
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::thread> threads;
  for (int i = 1; i < (options.threads > 0 ? options.threads : cores); ++i) {
    threads.emplace_back(work);
  }
  work();
  for (std::thread& thread : threads) thread.join();
  clearProgress();
  return sum;
}

int run(const Options& options) {
  SceneVerdict sum = judgeAll(options);
  std::sort(sum.wrong.begin(), sum.wrong.end());
  for (std::size_t i = 0; i < std::min(kMostLines, sum.wrong.size()); ++i) {
    std::printf("%s\n", sum.wrong[i].c_str());
  }
  std::printf("%d scenes: %d refused, as too few joints are actuated\n", sum.scenes, sum.refused);
  if (options.mixed) std::printf("%d that move freely, with residuals\n", sum.free);
  std::printf("%d not judged, as all loops are below 1e-4 of the mechanism\n", sum.small);
  std::printf("%d in singular positions, of %d of which nothing bears the load\n", sum.singular,
              sum.unborne);
  std::printf("%d whose rank is too close to the tolerance to judge\n", sum.unclear);
  std::printf("%d components, %d of them not determined; largest error %.3g of the bound\n",
              sum.components, sum.open, sum.over_bound);
  if (options.mixed) std::printf("%d forces that can act one way only\n", sum.holds);
  std::printf("largest condition %.3g\n%zu wrong\n", sum.condition, sum.wrong.size());
  return sum.wrong.empty() ? 0 : 1;
}

}  // namespace
}  // namespace virtual_work_dynamics

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  Options options;
  return runProgram("structured_loops", kHelp, argc, argv,
                    {count("--scenes", 8, options.scenes), count("--seed", 8, options.seed),
                     count("--first", 8, options.first), count("--threads", 3, options.threads),
                     flag("--mixed", options.mixed)},
                    [&] { return run(options); });
}
