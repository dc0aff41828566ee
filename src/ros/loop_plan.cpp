#include "ros/loop_plan.h"

#include <algorithm>

namespace virtual_work_dynamics {
namespace {

constexpr Determined kAll{true, true, true, true, true, true};

// Whether nothing is open now that is not open in other positions, too.
bool exists(const Determined& now, const Determined& usual) {
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (!now[i] && usual[i]) return false;
  }
  return true;
}

void setExisting(const std::vector<Determined>& now, const std::vector<Determined>& usual,
                 std::vector<bool>& existing) {
  for (std::size_t i = 0; i < now.size(); ++i) existing[i] = exists(now[i], usual[i]);
}

}  // namespace

LoopPlan::LoopPlan(const Mechanism& mechanism, const Scene& scene, const Request& request,
                   const std::vector<std::size_t>& wrenches)
    : dynamics_(mechanism, scene, request),
      wrenches_(wrenches),
      usual_effort_(dynamics_.effortDetermined().size(), true),
      usual_root_axes_(request.root_axes.size(), kAll),
      usual_child_axes_(request.child_axes.size(), kAll),
      effort_exists_(usual_effort_),
      root_axes_exist_(request.root_axes.size(), true),
      child_axes_exist_(request.child_axes.size(), true) {
  Motion assembled(dynamics_.coordinates());
  assembled.q = dynamics_.assembly();
  compute(assembled);
}

void LoopPlan::compute(const Motion& motion) {
  dynamics_.compute(motion);
  setExistence();
}

void LoopPlan::setExistence() {
  if (!singular()) {
    usual_effort_ = dynamics_.effortDetermined();
    usual_root_axes_ = dynamics_.rootAxesDetermined();
    usual_child_axes_ = dynamics_.childAxesDetermined();
  }
  for (std::size_t i = 0; i < effort_exists_.size(); ++i) {
    effort_exists_[i] = dynamics_.effortDetermined()[i] || !usual_effort_[i];
  }
  setExisting(dynamics_.rootAxesDetermined(), usual_root_axes_, root_axes_exist_);
  setExisting(dynamics_.childAxesDetermined(), usual_child_axes_, child_axes_exist_);
}

}  // namespace virtual_work_dynamics
