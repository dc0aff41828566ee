#include "ros/active_plan.h"

#include <utility>

namespace virtual_work_dynamics {

namespace {

constexpr std::size_t kPointsAtOnce = 64;

bool isEmpty(const Request& request) {
  return !request.efforts && request.child_axes.empty() && request.root_axes.empty();
}

// What is computed: that and what certificates need.
Request computed(const Request& request, PlanChecks checks) {
  return checks.certificates && !isEmpty(request) ? Certifier::extended(request) : request;
}

}  // namespace

Request requestFor(const Audience& audience, const std::vector<std::string>& joints, bool twist) {
  Request request;
  request.efforts = audience.effort || audience.trajectory;
  if (audience.reactions) {
    request.root_axes = joints;
    request.poses = true;
    request.twists = twist;
  }
  for (const std::size_t index : audience.wrenches) request.child_axes.push_back(joints[index]);
  return request;
}

std::string operationsOf(const InverseDynamics& dynamics) {
  const PlanSummary summary = dynamics.summary();
  if (summary.multiplications + summary.additions == 0) return "";
  return std::to_string(summary.multiplications) + " multiplications, " +
         std::to_string(summary.additions) + " additions, " +
         std::to_string(summary.sines_and_cosines) + " sines and cosines";
}

ActivePlan::ActivePlan(const Mechanism& mechanism, const Scene& scene, const Request& request,
                       Audience who, const std::string& frame_prefix, PlanChecks checks)
    : audience(std::move(who)),
      dynamics(mechanism, scene, computed(request, checks)),
      results(dynamics.makeWorkspace()),
      points(dynamics, kPointsAtOnce),
      messages(mechanism, request, frame_prefix) {
  if (isEmpty(request)) return;
  if (checks.cross_check) {
    cross_check = std::make_shared<CrossCheckSlot>(mechanism, scene, dynamics.request());
  }
  if (checks.certificates) {
    certifier.emplace(mechanism, scene);
    ground = Certifier::groundIndex(dynamics.request());
  }
}

std::string describe(const ActivePlan& plan) {
  const Request& request = plan.dynamics.request();
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (request.efforts) add("efforts");
  if (!request.root_axes.empty()) {
    add(std::to_string(request.root_axes.size()) + " reactions in root axes");
  }
  if (!request.child_axes.empty()) {
    add(std::to_string(request.child_axes.size()) + " reactions in child axes");
  }
  if (request.poses) add("poses");
  if (request.twists) add("twists");
  if (plan.certifier) add("certificates");
  return text.empty() ? "nothing" : text;
}

}  // namespace virtual_work_dynamics
