#include "held_mechanisms.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kRate = MotionRange().rate, kAcceleration = MotionRange().acceleration;

StabilityCase heldCase(const Held& held) {
  const auto motion = [](RandomNumbers& random) {
    Motion state(1);  // the closure holds the one coordinate at zero, whatever its rates
    state.qd << random.uniform(-kRate, kRate);
    state.qdd << random.uniform(-kAcceleration, kAcceleration);
    return state;
  };
  return {held.mechanism, held.scene, motion};
}

std::string sceneName(const Held& held) {
  std::string name = "loop_" + held.name;
  for (char& letter : name) letter = letter == ' ' ? '_' : letter;
  return name;
}

}  // namespace

// Beyond the least values nothing holds the coordinate, and the scene is refused.
std::vector<Sweep> heldSweeps() {
  std::vector<Sweep> sweeps;
  for (const auto& make : kHeldMechanisms) {
    sweeps.push_back({sceneName(make(1)), "lever or slope of the closure [size]",
                      powersOfTen(-9, 0), [make](double y) { return heldCase(make(y)); }});
  }
  return sweeps;
}

}  // namespace virtual_work_dynamics
