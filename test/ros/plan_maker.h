#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/active_plan.h"
#include "ros/certificate_record.h"
#include "ros/counters.h"
#include "ros/loop_record.h"
#include "ros/motion_completer.h"
#include "ros/outputs.h"
#include "ros/sample_computation.h"

namespace virtual_work_dynamics {

using Topics = std::vector<std::string>;

/// Compiles plans as the node does, and computes by them.
struct PlanMaker {
  PlanMaker(const Mechanism& of, const Scene& wanted, bool twist = false,
            const LoopLimits& limits = {1e-6, 1e4}, const std::string& frame_prefix = "")
      : mechanism(of),
        scene(wanted),
        reactions(requestedReactions(mechanism, scene)),
        everything(mechanism, scene),
        deviations(std::make_shared<DeviationRecord>(
            everything.effortNames(), everything.residuals(), mechanism.coordinateNames())),
        outputs(makeOutputs(
            mechanism, everything,
            {reactions, reactions, frame_prefix, twist, limits.condition, scene, deviations})),
        loops(everything, reactions.size(), limits),
        completer(mechanism, scene, everything),
        wrenches(mechanism, scene, 0.1),
        samples(everything, scene, completer, wrenches, {counters, certificates, loops}) {}

  /// The audience of these topics.
  Audience audience(const Topics& topics) const {
    Audience audience;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      for (const std::string& topic : topics) {
        if (outputs[i]->topic() == topic) audience.push_back(i);
      }
    }
    if (audience.size() != topics.size()) throw std::invalid_argument("a topic is missing");
    return audience;
  }

  std::unique_ptr<ActivePlan> compile(const Topics& topics, PlanChecks checks = {}) const {
    return std::make_unique<ActivePlan>(mechanism, scene, outputs, reactions, audience(topics),
                                        checks);
  }

  /// The message that a plan writes for a topic.
  template <typename Message>
  const MessageOf<Message>& message(const ActivePlan& plan, const std::string& topic) const {
    for (const ActiveOutput& output : plan.outputs) {
      if (outputs[output.index]->topic() != topic) continue;
      return dynamic_cast<const MessageOf<Message>&>(*output.message);
    }
    throw std::invalid_argument("the plan has no " + topic);
  }

  const Mechanism& mechanism;
  const Scene& scene;
  std::vector<std::string> reactions;
  Dynamics everything;
  std::shared_ptr<DeviationRecord> deviations;
  Outputs outputs;
  Counters counters;
  CertificateRecord certificates;
  LoopRecord loops;
  MotionCompleter completer;
  LiveWrenches wrenches;
  SampleComputation samples;
};

}  // namespace virtual_work_dynamics
