#pragma once

#include <algorithm>
#include <vector>

#include "contenders/contender.h"

namespace virtual_work_dynamics {

/// What completions start from: the scene's motions with passive joints where they were a sample
/// of 1 ms before, and their rates unknown.
inline std::vector<Motion> startsOfCompletions(const BenchmarkScene& scene) {
  constexpr double kSamplePeriod = 1e-3;  // s
  std::vector<Motion> starts = scene.motions;
  if (!scene.loops->actuated) return starts;
  const std::vector<std::string>& actuated = *scene.loops->actuated;
  const std::vector<std::string>& names = scene.mechanism.coordinateNames();
  for (Motion& start : starts) {
    for (Eigen::Index i = 0; i < start.q.size(); ++i) {
      const std::string& name = names[static_cast<std::size_t>(i)];
      if (std::count(actuated.begin(), actuated.end(), name) > 0) continue;
      start.q[i] -= kSamplePeriod * start.qd[i];
      start.qd[i] = start.qdd[i] = 0;
    }
  }
  return starts;
}

inline SampleResults resultsOf(const Motion& completed) {
  SampleResults results;
  for (const Eigen::VectorXd* values : {&completed.q, &completed.qd, &completed.qdd}) {
    results.motion.insert(results.motion.end(), values->data(), values->data() + values->size());
  }
  return results;
}

}  // namespace virtual_work_dynamics
