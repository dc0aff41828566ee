#pragma once

#include "tree/plan.h"
#include "virtual_work_dynamics/plan_summary.h"

namespace virtual_work_dynamics {

/// Counts the operations of one evaluation of everything requested, by running it.
PlanSummary summarize(const Plan<double>& plan);

}  // namespace virtual_work_dynamics
