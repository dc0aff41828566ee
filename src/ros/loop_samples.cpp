#include "ros/loop_samples.h"

#include "ros/output_messages.h"

namespace virtual_work_dynamics {

LoopSamples::LoopSamples(const Mechanism& mechanism, const Scene& scene,
                         const std::vector<std::string>& reactions, const LoopLimits& within)
    : limits(within),
      completer(mechanism, scene),
      record(scene.closures.size(), namesOfEfforts(mechanism, scene).size(), reactions.size()),
      determinacy(mechanism.name(), namesOfEfforts(mechanism, scene), reactions, within.condition) {
  record.setPassiveGiven(completer.passiveGiven());
  // Everything, where the closures were assembled: there is always a latest message.
  LoopPlan assembled(mechanism, scene, Request{true, reactions, reactions, false, false},
                     std::vector<std::size_t>(reactions.size()));
  determinacy.update(0, assembled.results());
}

}  // namespace virtual_work_dynamics
