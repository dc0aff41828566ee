#include <algorithm>
#include <cstdio>
#include <memory>

#include "base/output_file.h"
#include "contenders/closed_scenes.h"
#include "cores.h"
#include "measurement.h"
#include "result_table.h"
#include "work_precision_options.h"

namespace virtual_work_dynamics {
namespace {

struct Effort {
  int rounds;
  double seconds;  // for each contender in a round
};
constexpr Effort kUsual{15, 10e-3};
constexpr Effort kQuick{5, 2e-3};

bool among(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

// Names of the wanted scenes; says which have no file. A quick run leaves out what takes long,
// unless asked for by name.
std::vector<std::string> scenesToTime(const WorkPrecisionOptions& options) {
  std::vector<std::string> names;
  for (const std::string& name : sceneNames()) {
    if (!among(options.scenes, name)) continue;
    if (options.quick && options.scenes.empty() && takesSeconds(name)) continue;
    const std::string missing = missingFile(name);
    if (missing.empty()) {
      names.push_back(name);
    } else {
      std::fprintf(stderr, "%s: skipped, %s is not there\n", name.c_str(), missing.c_str());
    }
  }
  return names;
}

std::vector<Offer> wantedOffers(const BenchmarkScene& scene, const WorkPrecisionOptions& options) {
  std::vector<Offer> offers;
  for (Offer& offer : offersFor(scene)) {
    if (among(options.methods, offer.label.method)) offers.push_back(std::move(offer));
  }
  return offers;
}

// Every method can compute a chain or a four-bar linkage.
void checkMethods(const std::vector<std::string>& methods) {
  const BenchmarkScene chain = makeScene("chain_2"), linkage = makeScene("four_bar");
  std::vector<Offer> offers = offersFor(chain);
  for (Offer& offer : offersFor(linkage)) offers.push_back(std::move(offer));
  for (const std::string& method : methods) {
    const auto known = [&](const Offer& offer) { return offer.label.method == method; };
    if (std::none_of(offers.begin(), offers.end(), known)) {
      throw OptionError("--method: this build has no method '" + method + "'; --list shows all");
    }
  }
}

int list(const WorkPrecisionOptions& options) {
  std::printf("scene,method,precision,mode,outputs,threads\n");
  for (const std::string& name : scenesToTime(options)) {
    const BenchmarkScene scene = makeScene(name);
    for (const Offer& offer : wantedOffers(scene, options)) {
      const Label& label = offer.label;
      std::printf("%s,%s,%s,%s,%s,%d\n", name.c_str(), label.method.c_str(),
                  label.precision.c_str(), label.mode.c_str(), label.outputs.c_str(),
                  label.threads);
    }
  }
  return 0;
}

int listLoops(const WorkPrecisionOptions& options) {
  std::printf("scene,coordinates,actuated,loops,conditions,redundant_constraints\n");
  for (const std::string& name : scenesToTime(options)) {
    if (!isClosedScene(name)) continue;
    const LoopCounts counts = countLoops(makeScene(name));
    std::printf("%s,%d,%zu,%zu,%d,%d\n", name.c_str(), static_cast<int>(counts.coordinates),
                counts.actuated, counts.closures, counts.conditions, counts.redundant_constraints);
  }
  return 0;
}

int run(const WorkPrecisionOptions& options) {
  std::unique_ptr<OutputFile> output;
  if (!options.output.empty()) output = std::make_unique<OutputFile>(options.output);
  const int core = stayOnOneCore();
  if (core < 0) std::fprintf(stderr, "Not allowed to stay on one core; times may scatter.\n");
  if (core >= 0) std::printf("On core %d; what has several threads, on all cores.\n", core);

  const Effort& effort = options.quick ? kQuick : kUsual;
  const int rounds = options.rounds > 0 ? options.rounds : effort.rounds;
  const std::vector<std::string> names = scenesToTime(options);
  std::vector<ResultRow> all_rows;
  bool disagreed = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t steps = static_cast<std::size_t>(rounds) + 1;
    const auto show = [&](std::size_t step) {
      showProgress(names[i], i * steps + step, names.size() * steps);
    };
    show(0);
    const BenchmarkScene scene = makeScene(names[i]);
    std::vector<Candidate> candidates =
        checkedCandidates(scene, wantedOffers(scene, options), disagreed);
    timeInTurn(candidates, rounds, effort.seconds,
               [&](int round) { show(static_cast<std::size_t>(round) + 1); });
    std::vector<ResultRow> rows;
    for (const Candidate& candidate : candidates) rows.push_back(resultRow(names[i], candidate));
    clearProgress();
    std::printf("%s", resultTable(names[i], rows).c_str());
    std::fflush(stdout);
    all_rows.insert(all_rows.end(), rows.begin(), rows.end());
  }
  if (output) {
    output->write(resultCsv(all_rows));
    output->commit();
  }
  return disagreed ? 1 : 0;
}

}  // namespace
}  // namespace virtual_work_dynamics

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  WorkPrecisionOptions options;
  return runProgram("work_precision", kWorkPrecisionHelp, argc, argv, commandLine(options), [&] {
    if (!options.description.empty()) {
      std::printf("%s", sceneUrdf(options.description).c_str());
      return 0;
    }
    checkMethods(options.methods);
    if (options.list) return list(options);
    return options.list_loops ? listLoops(options) : run(options);
  });
}
