#include "contenders/check.h"

#include <algorithm>
#include <limits>

#include "contenders/peer_input.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// An absolute error, made relative; no result may differ where all of them are zero. NaN stays.
Real113 relative(Real113 error, Real113 largest) {
  return error == 0 ? Real113(0) : error / largest;
}

void checkCount(const char* what, std::size_t count, std::size_t expected) {
  if (count == expected) return;
  throw Error("gives " + std::to_string(count) + ' ' + what + " where there are " +
              std::to_string(expected));
}

}  // namespace

Yardstick::Yardstick(const BenchmarkScene& scene) {
  Scene gravity_only;
  gravity_only.gravity = scene.gravity;
  for (const Motion& motion : scene.motions) {
    const Reference113 reference(scene.mechanism, gravity_only, motion);
    State state;
    state.efforts = reference.efforts();
    for (const Real113 effort : state.efforts) {
      state.largest_effort = std::max(state.largest_effort, magnitude(effort));
    }
    for (const int joint : movableJoints(scene.mechanism)) {
      state.reactions.push_back(reference.childAxes(joint));
      const Reference113::Wrench& wrench = state.reactions.back();
      state.largest_force = std::max(state.largest_force, norm(wrench.force));
      state.largest_moment = std::max(state.largest_moment, norm(wrench.torque));
    }
    states_.push_back(std::move(state));
  }
}

double Yardstick::maxRelativeError(Contender& contender, bool with_reactions) const {
  const std::size_t per_call = contender.samplesPerCall();
  Real113 largest = 0;
  std::vector<SampleResults> seen(states_.size());  // long blocks repeat the states many times
  for (std::size_t done = 0; done < kStates; done += per_call) {
    contender.run(1);
    for (std::size_t n = 0; n < per_call; ++n) {
      const std::size_t state = (done + n) % states_.size();
      SampleResults results = contender.results(n);
      if (results.efforts == seen[state].efforts && results.reactions == seen[state].reactions &&
          !results.efforts.empty()) {
        continue;
      }
      const Real113 error = relativeError(results, states_[state], with_reactions);
      seen[state] = std::move(results);
      if (!isFinite(error)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, error);
    }
  }
  return static_cast<double>(largest);
}

Real113 Yardstick::relativeError(const SampleResults& results, const State& state,
                                 bool with_reactions) {
  checkCount("efforts", results.efforts.size(), state.efforts.size());
  Real113 sum_of_bad = 0;  // NaN as soon as one result is: std::max would hide it
  Real113 largest = 0;
  const auto take = [&](Real113 error) {
    sum_of_bad += error - error;
    largest = std::max(largest, error);
  };
  for (std::size_t i = 0; i < state.efforts.size(); ++i) {
    take(relative(magnitude(results.efforts[i] - state.efforts[i]), state.largest_effort));
  }
  const std::size_t reactions = with_reactions ? state.reactions.size() : 0;
  checkCount("numbers of reactions", results.reactions.size(), 6 * reactions);
  for (std::size_t k = 0; k < reactions; ++k) {
    const long double* wrench = &results.reactions[6 * k];
    const Vector113 force{wrench[0], wrench[1], wrench[2]};
    const Vector113 moment{wrench[3], wrench[4], wrench[5]};
    take(relative(norm(force - state.reactions[k].force), state.largest_force));
    take(relative(norm(moment - state.reactions[k].torque), state.largest_moment));
  }
  return largest + sum_of_bad;
}

double agreementLimit(const std::string& precision) {
  return precision == "float" ? 1e-3 : 1e-9;
}

}  // namespace virtual_work_dynamics
