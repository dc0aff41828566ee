#pragma once

#include "scene/payloads.h"
#include "tree/kernel/kernel_choice.h"
#include "tree/plan.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// The inside of an InverseDynamics, which blocks share.
struct InverseDynamics::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& wanted, InstructionSet set)
      : request(wanted),
        exact(compilePlan(LoadedMechanism(mechanism, scene).get(), scene, wanted)),
        plan(roundPlan<double>(exact)),
        view(viewOf(plan)),
        instruction_set(set),
        kernel(&kernelFor<double>(set)) {}

  Request request;
  Plan<long double> exact;
  Plan<double> plan;
  PlanView<double> view;
  InstructionSet instruction_set;
  const Kernel<double>* kernel;
};

}  // namespace virtual_work_dynamics
