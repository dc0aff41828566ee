#include "contenders/check.h"

#include <algorithm>
#include <limits>

#include "contenders/peer_input.h"
#include "maximal_coordinates_oracle.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Joints and closures up to which all states are compared: some milliseconds each.
constexpr std::size_t kMostWrenches = 50;

// An absolute error, made relative; no result may differ where all of them are zero. NaN stays.
Real113 relative(Real113 error, Real113 largest) {
  return error == 0 ? Real113(0) : error / largest;
}

// NaN as soon as one error is: std::max would hide it.
class LargestError {
 public:
  void take(Real113 error, Real113 largest) {
    const Real113 ratio = relative(error, largest);
    sum_of_bad_ += ratio - ratio;
    largest_ = std::max(largest_, ratio);
  }
  Real113 get() const { return largest_ + sum_of_bad_; }

 private:
  Real113 largest_ = 0, sum_of_bad_ = 0;
};

void checkCount(const char* what, std::size_t count, std::size_t expected) {
  if (count == expected) return;
  throw Error("gives " + std::to_string(count) + ' ' + what + " where there are " +
              std::to_string(expected));
}

}  // namespace

Yardstick::Yardstick(const BenchmarkScene& scene) {
  std::size_t states = scene.motions.size();
  if (scene.loops) {
    const std::size_t wrenches = scene.mechanism.joints().size() + scene.loops->closures.size();
    if (wrenches > kMostWrenches) states = 1;
  }
  for (std::size_t n = 0; n < states; ++n) {
    const Motion& motion = scene.motions[n];
    states_.push_back(scene.loops ? stateOfLoops(scene, motion) : stateOfTree(scene, motion));
    states_.back().motion = &motion;
  }
}

Yardstick::State Yardstick::stateOfTree(const BenchmarkScene& scene, const Motion& motion) {
  constexpr std::array<bool, 6> kAll = {true, true, true, true, true, true};
  Scene gravity_only;
  gravity_only.gravity = scene.gravity;
  const Reference113 reference(scene.mechanism, gravity_only, motion);
  State state;
  for (const Real113 effort : reference.efforts()) {
    state.efforts.push_back({effort, true});
    state.largest_effort = std::max(state.largest_effort, magnitude(effort));
  }
  for (const int joint : movableJoints(scene.mechanism)) {
    addReaction(state, {reference.childAxes(joint), kAll});
  }
  return state;
}

Yardstick::State Yardstick::stateOfLoops(const BenchmarkScene& scene, const Motion& motion) {
  const MaximalCoordinatesOracle reference(scene.mechanism, *scene.loops, motion);
  State state;
  for (std::size_t i = 0; i < scene.mechanism.coordinates().size(); ++i) {
    const auto effort = reference.effort(static_cast<int>(i));
    state.efforts.push_back({effort.value, effort.determined});
    if (!effort.determined) continue;
    state.largest_effort = std::max(state.largest_effort, magnitude(effort.value));
  }
  for (const std::string& name : requestedReactions(scene.mechanism, *scene.loops)) {
    const auto found = reference.childAxes(name);
    std::array<Real113, 6> w;
    for (std::size_t i = 0; i < 6; ++i) {
      w[i] = found.determined[i] ? found.wrench[static_cast<Eigen::Index>(i)] : 0;
    }
    addReaction(state, {{{w[0], w[1], w[2]}, {w[3], w[4], w[5]}}, found.determined});
  }
  return state;
}

void Yardstick::addReaction(State& state, const Reaction& reaction) {
  state.reactions.push_back(reaction);
  state.largest_force = std::max(state.largest_force, norm(reaction.wrench.force));
  state.largest_moment = std::max(state.largest_moment, norm(reaction.wrench.torque));
}

double Yardstick::maxRelativeError(Contender& contender, const std::string& outputs) const {
  const std::size_t per_call = contender.samplesPerCall();
  Real113 largest = 0;
  std::vector<SampleResults> seen(states_.size());  // long blocks repeat the states many times
  for (std::size_t done = 0; done < states_.size(); done += per_call) {
    contender.run(1);
    for (std::size_t n = 0; n < per_call; ++n) {
      const std::size_t state = (done + n) % states_.size();
      SampleResults results = contender.results(n);
      if (results.efforts == seen[state].efforts && results.reactions == seen[state].reactions &&
          results.motion == seen[state].motion && !results.efforts.empty()) {
        continue;
      }
      const Real113 error = relativeError(results, states_[state], outputs);
      seen[state] = std::move(results);
      if (!isFinite(error)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, error);
    }
  }
  return static_cast<double>(largest);
}

Real113 Yardstick::relativeError(const SampleResults& results, const State& state,
                                 const std::string& outputs) {
  LargestError error;
  if (outputs == kCompletedMotion) {
    const Motion& motion = *state.motion;
    const std::size_t n = static_cast<std::size_t>(motion.q.size());
    checkCount("numbers of the motion", results.motion.size(), 3 * n);
    const long double* completed = results.motion.data();
    for (const Eigen::VectorXd* expected : {&motion.q, &motion.qd, &motion.qdd}) {
      const Real113 largest = expected->cwiseAbs().maxCoeff();
      for (Eigen::Index i = 0; i < expected->size(); ++i) {
        error.take(magnitude(*completed++ - (*expected)[i]), largest);
      }
    }
    return error.get();
  }
  checkCount("efforts", results.efforts.size(), state.efforts.size());
  for (std::size_t i = 0; i < state.efforts.size(); ++i) {
    if (!state.efforts[i].determined) continue;
    error.take(magnitude(results.efforts[i] - state.efforts[i].value), state.largest_effort);
  }
  const std::size_t reactions = outputs == kEffortsAndReactions ? state.reactions.size() : 0;
  checkCount("numbers of reactions", results.reactions.size(), 6 * reactions);
  for (std::size_t k = 0; k < reactions; ++k) {
    const Reaction& expected = state.reactions[k];
    std::array<Real113, 6> w;
    for (std::size_t i = 0; i < 6; ++i) {
      w[i] = expected.determined[i] ? results.reactions[6 * k + i] : 0;
    }
    const Vector113 force{w[0], w[1], w[2]}, moment{w[3], w[4], w[5]};
    error.take(norm(force - expected.wrench.force), state.largest_force);
    error.take(norm(moment - expected.wrench.torque), state.largest_moment);
  }
  return error.get();
}

double agreementLimit(const std::string& precision) {
  return precision == "float" ? 1e-3 : 1e-9;
}

}  // namespace virtual_work_dynamics
