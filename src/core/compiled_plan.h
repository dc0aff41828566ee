#pragma once

#include "core/kernel/kernel.h"
#include "core/plan.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// The inside of an InverseDynamics, which blocks share.
struct InverseDynamics::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& wanted,
       InstructionSet instruction_set)
      : request(wanted),
        exact(compilePlan(mechanism, scene, wanted)),
        plan(roundPlan<double>(exact)),
        view(viewOf(plan)),
        kernel(&kernelFor<double>(instruction_set)) {}

  Request request;
  Plan<long double> exact;
  Plan<double> plan;
  PlanView<double> view;
  const Kernel<double>* kernel;
};

}  // namespace virtual_work_dynamics
