#include "ros/active_plan.h"

#include <numeric>
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

// With determinacy, everything that the scene asks for.
std::unique_ptr<LoopPlan> compileLoops(const Mechanism& mechanism, const Scene& scene,
                                       Request request, const Audience& audience,
                                       PlanChecks checks) {
  std::vector<std::size_t> wrenches = audience.wrenches;
  if (audience.determinacy) {
    request.efforts = true;
    request.root_axes = request.child_axes = requestedReactions(mechanism, scene);
    wrenches.resize(request.child_axes.size());
    std::iota(wrenches.begin(), wrenches.end(), 0);
  }
  return std::make_unique<LoopPlan>(mechanism, scene, computed(request, checks), wrenches);
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

std::string operationsOf(const ActivePlan& plan) {
  if (plan.loops) return "";
  const PlanSummary summary = plan.chain->dynamics.summary();
  if (summary.multiplications + summary.additions == 0) return "";
  return std::to_string(summary.multiplications) + " multiplications, " +
         std::to_string(summary.additions) + " additions, " +
         std::to_string(summary.sines_and_cosines) + " sines and cosines";
}

ChainPlan::ChainPlan(const Mechanism& mechanism, const Scene& scene, const Request& request)
    : dynamics(mechanism, scene, request),
      results(dynamics.makeWorkspace()),
      points(dynamics, kPointsAtOnce) {}

ActivePlan::ActivePlan(const Mechanism& mechanism, const Scene& scene, const Request& request,
                       Audience who, const std::string& frame_prefix, PlanChecks checks)
    : audience(std::move(who)), messages(mechanism, scene, request, frame_prefix) {
  if (needsClosedLoops(scene)) {
    loops = compileLoops(mechanism, scene, request, audience, checks);
    messages.setComputed(loops->results().request());
    if (isEmpty(loops->results().request())) return;
    if (checks.cross_check) {
      cross_check = std::make_shared<CrossCheckSlot>(mechanism, loops->results());
    }
    if (checks.certificates) {
      certifier.emplace(mechanism, loops->results().tree());
      ground = Certifier::groundIndex(loops->results().request());
    }
    return;
  }
  chain.emplace(mechanism, scene, computed(request, checks));
  if (isEmpty(request)) return;
  if (checks.cross_check) {
    cross_check = std::make_shared<CrossCheckSlot>(mechanism, scene, chain->dynamics.request());
  }
  if (checks.certificates) {
    certifier.emplace(mechanism, scene);
    ground = Certifier::groundIndex(chain->dynamics.request());
  }
}

const Request& ActivePlan::request() const {
  return loops ? loops->results().request() : chain->dynamics.request();
}

const Eigen::VectorXd& ActivePlan::effort() const {
  return loops ? loops->results().effort() : chain->results.effort();
}

std::string describe(const ActivePlan& plan) {
  const Request& request = plan.request();
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
  if (plan.loops && !text.empty()) add("closed loops");
  return text.empty() ? "nothing" : text;
}

}  // namespace virtual_work_dynamics
