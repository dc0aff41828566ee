#include "ros/plan_switch.h"

namespace virtual_work_dynamics {

PlanSwitch::PlanSwitch(std::unique_ptr<ActivePlan> first) : current_(first.release()) {}

PlanSwitch::~PlanSwitch() {
  delete offered_.load();
  delete retired_.load();
  delete current_;
}

void PlanSwitch::offer(std::unique_ptr<ActivePlan> plan) {
  const std::unique_ptr<ActivePlan> never_taken(offered_.exchange(plan.release()));
  collect();
}

void PlanSwitch::collect() {
  const std::unique_ptr<ActivePlan> replaced(retired_.exchange(nullptr));
}

ActivePlan& PlanSwitch::current() {
  // While the slot for the replaced plan is still full, the switch waits for the next sample.
  if (offered_.load(std::memory_order_relaxed) != nullptr && retired_.load() == nullptr) {
    // Only the compiling thread fills offered_, and it does not empty it again.
    ActivePlan* const next = offered_.exchange(nullptr);
    retired_.store(current_);
    current_ = next;
  }
  return *current_;
}

}  // namespace virtual_work_dynamics
