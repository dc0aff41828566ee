#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contenders/contender.h"

namespace virtual_work_dynamics {

/// A contender that computes the right numbers, with the times that it took.
struct Candidate {
  Label label;
  double max_relative_error = 0;
  std::unique_ptr<Contender> contender;
  std::vector<double> ns_per_sample;  ///< one for each round
};

/// Sets up and checks the offers. One that fails or disagrees is named on stderr and left out.
/// @param disagreed becomes true when one is left out; otherwise unchanged.
std::vector<Candidate> checkedCandidates(const BenchmarkScene& scene,
                                         const std::vector<Offer>& offers, bool& disagreed);

/// Times all candidates in turn, `rounds` times, each about `seconds` long, with Google Benchmark.
/// Candidates of one thread run on one core and are timed by the time that the thread has run,
/// those of several threads run on all cores and are timed by the clock.
/// @param progress is called before each round with its number, which counts from 0.
void timeInTurn(std::vector<Candidate>& candidates, int rounds, double seconds,
                const std::function<void(int)>& progress);

}  // namespace virtual_work_dynamics
