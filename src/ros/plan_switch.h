#pragma once

#include <atomic>
#include <memory>

#include "ros/active_plan.h"

namespace virtual_work_dynamics {

/// Hands plans from the thread that compiles them to the thread that computes, and the replaced
/// ones back for deletion. The computing side neither waits, allocates nor frees.
class PlanSwitch {
 public:
  /// @param first the plan in use at the start
  explicit PlanSwitch(std::unique_ptr<ActivePlan> first);
  /// To be called only when no thread uses the switch any more.
  ~PlanSwitch();
  PlanSwitch(const PlanSwitch&) = delete;
  PlanSwitch& operator=(const PlanSwitch&) = delete;

  /// For the compiling thread: makes `plan` the one that current() returns next. A plan that was
  /// offered before and never taken is deleted.
  void offer(std::unique_ptr<ActivePlan> plan);
  /// For the compiling thread: deletes the plan that has been replaced, if any.
  void collect();

  /// For the computing thread: returns the newest plan. The plan of the call before must no longer
  /// be used.
  ActivePlan& current();

 private:
  std::atomic<ActivePlan*> offered_{nullptr};
  std::atomic<ActivePlan*> retired_{nullptr};
  ActivePlan* current_;  // used by the computing thread only
};

}  // namespace virtual_work_dynamics
