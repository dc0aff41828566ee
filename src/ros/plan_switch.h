#pragma once

#include <atomic>
#include <memory>

#include "ros/active_plan.h"

namespace virtual_work_dynamics {

/// Hands plans from the thread that compiles them to the thread that computes, and the replaced ones
/// back for deletion. The computing side neither waits, allocates nor frees.
class PlanSwitch {
 public:
  /// @param first in use from the start.
  explicit PlanSwitch(std::unique_ptr<ActivePlan> first);
  /// Only when no thread uses it any more.
  ~PlanSwitch();
  PlanSwitch(const PlanSwitch&) = delete;
  PlanSwitch& operator=(const PlanSwitch&) = delete;

  /// Compiling thread: makes `plan` the one that current() will return next. One that was offered
  /// before and never taken is deleted.
  void offer(std::unique_ptr<ActivePlan> plan);
  /// Compiling thread: deletes the plan that has been replaced, if any.
  void collect();

  /// Computing thread: the newest plan. The one of the call before must no longer be used.
  ActivePlan& current();

 private:
  std::atomic<ActivePlan*> offered_{nullptr};
  std::atomic<ActivePlan*> retired_{nullptr};
  ActivePlan* current_;  // the computing thread's own
};

}  // namespace virtual_work_dynamics
