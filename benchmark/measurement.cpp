#include "measurement.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "contenders/check.h"
#include "cores.h"

namespace virtual_work_dynamics {
namespace {

// Long enough that Google Benchmark's own loop around it does not count.
constexpr double kBatchSeconds = 100e-6;

void chooseCores(const Label& label) {
  if (label.threads > 1) {
    useAllCores();
  } else {
    stayOnOneCore();
  }
}

std::string describe(const Label& label) {
  return label.method + ' ' + label.mode + ' ' + label.precision + ' ' + label.outputs + ", " +
         std::to_string(label.threads) + (label.threads == 1 ? " thread" : " threads");
}

// How many calls and how many times as many are timed at once.
struct Batches {
  std::size_t calls = 1;  // in a batch
  std::size_t count = 1;
};

Batches batchesFor(Contender& contender, double seconds) {
  using Clock = std::chrono::steady_clock;
  Batches batches;
  for (;; batches.calls *= 2) {
    const Clock::time_point start = Clock::now();
    contender.run(batches.calls);
    const double batch_seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (batch_seconds < kBatchSeconds) continue;
    batches.count = static_cast<std::size_t>(std::max(1.0, std::round(seconds / batch_seconds)));
    return batches;
  }
}

// Takes the runs of one round. Benchmarks are named by the candidates' places.
class RoundReporter : public benchmark::BenchmarkReporter {
 public:
  RoundReporter(std::vector<Candidate>& candidates, const std::vector<Batches>& batches)
      : candidates_(candidates), batches_(batches) {}

  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const std::size_t place = std::strtoul(run.benchmark_name().c_str(), nullptr, 10);
      Candidate& candidate = candidates_[place];
      const double seconds =
          candidate.label.threads > 1 ? run.real_accumulated_time : run.cpu_accumulated_time;
      const double samples = static_cast<double>(run.iterations) *
                             static_cast<double>(batches_[place].calls) *
                             static_cast<double>(candidate.contender->samplesPerCall());
      candidate.ns_per_sample.push_back(seconds * 1e9 / samples);
    }
  }

 private:
  std::vector<Candidate>& candidates_;
  const std::vector<Batches>& batches_;
};

void registerCandidate(std::size_t place, Candidate& candidate, const Batches& batches) {
  const auto timed = [&candidate, &batches](benchmark::State& state) {
    chooseCores(candidate.label);
    candidate.contender->run(1);  // after the others, nothing of its own is in the caches
    for (auto unused : state) {
      static_cast<void>(unused);
      candidate.contender->run(batches.calls);
    }
  };
  auto* registered = benchmark::RegisterBenchmark(std::to_string(place).c_str(), timed);
  registered->Iterations(static_cast<benchmark::IterationCount>(batches.count));
  if (candidate.label.threads > 1) registered->UseRealTime();
}

}  // namespace

std::vector<Candidate> checkedCandidates(const BenchmarkScene& scene,
                                         const std::vector<Offer>& offers, bool& disagreed) {
  const Yardstick yardstick(scene);
  std::vector<Candidate> candidates;
  for (const Offer& offer : offers) {
    const std::string name = scene.name + ": " + describe(offer.label);
    chooseCores(offer.label);
    try {
      std::unique_ptr<Contender> contender = offer.make();
      const double error = yardstick.maxRelativeError(*contender, offer.label.outputs);
      if (!(error <= agreementLimit(offer.label.precision))) {
        std::fprintf(stderr, "%s: disagrees with the reference, relative error %.2g; not timed\n",
                     name.c_str(), error);
        disagreed = true;
        continue;
      }
      candidates.push_back({offer.label, error, std::move(contender), {}});
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s; not timed\n", name.c_str(), error.what());
      disagreed = true;
    }
  }
  return candidates;
}

void timeInTurn(std::vector<Candidate>& candidates, int rounds, double seconds,
                const std::function<void(int)>& progress) {
  if (candidates.empty()) return;
  std::vector<Batches> batches;
  for (Candidate& candidate : candidates) {
    chooseCores(candidate.label);
    batches.push_back(batchesFor(*candidate.contender, seconds));
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    registerCandidate(i, candidates[i], batches[i]);
  }
  RoundReporter reporter(candidates, batches);
  for (int round = 0; round < rounds; ++round) {
    progress(round);
    benchmark::RunSpecifiedBenchmarks(&reporter);
  }
  benchmark::ClearRegisteredBenchmarks();
  stayOnOneCore();
}

}  // namespace virtual_work_dynamics
