#include "ros/active_plan.h"

#include <string>
#include <unordered_map>
#include <utility>

namespace virtual_work_dynamics {

namespace {

bool isEmpty(const Request& request) {
  return !request.efforts && request.child_axes.empty() && request.root_axes.empty();
}

// Adds what certificates and diagnostics need to what outputs need.
Request computed(const Scene& scene, Request request, PlanChecks checks) {
  request.can_hold = scene.contact_intervals;
  return checks.certificates && !isEmpty(request) ? Certifier::extended(request) : request;
}

std::vector<std::size_t> placesOf(const std::vector<std::string>& names,
                                  const std::vector<std::string>& all) {
  std::unordered_map<std::string, std::size_t> place_of;
  for (const std::string& name : all) place_of.emplace(name, place_of.size());
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto place = place_of.find(name);
    places.push_back(place == place_of.end() ? all.size() : place->second);
  }
  return places;
}

}  // namespace

ActivePlan::ActivePlan(const Mechanism& mechanism, const Scene& scene, const Outputs& all,
                       const std::vector<std::string>& reactions, Audience who, PlanChecks checks)
    : audience(std::move(who)),
      dynamics(mechanism, scene, computed(scene, requestFor(all, audience), checks)),
      workspace(dynamics.makeWorkspace()),
      points(dynamics, kPointsAtOnce),
      fit(mechanism, dynamics, checks.loop_tolerance) {
  for (const std::size_t i : audience) {
    outputs.push_back({i, all[i]->ofTrajectories(), all[i]->makeMessage(dynamics, scene)});
    (outputs.back().of_trajectories ? wants_trajectories : wants_samples) = true;
    wants_covariance = wants_covariance || all[i]->usesCovariance();
  }
  const Request request = requestFor(all, audience);
  if (isEmpty(request)) return;
  root_reactions = placesOf(request.root_axes, reactions);
  child_reactions = placesOf(request.child_axes, reactions);
  if (checks.cross_check) cross_check = std::make_shared<CrossCheckSlot>(mechanism, dynamics);
  if (checks.certificates) {
    certifier.emplace(mechanism, dynamics.tree());
    ground = Certifier::groundIndex(dynamics.request());
    tree_load = Load(dynamics.tree());
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
  if (plan.wantsCovariance()) add("deviations");
  if (plan.certifier) add("certificates");
  if (text.empty() && plan.wantsSamples()) add("motions");
  if (plan.dynamics.closed() && !text.empty()) add("closed loops");
  return text.empty() ? "nothing" : text;
}

std::string operationsOf(const ActivePlan& plan) {
  if (plan.dynamics.closed()) return "";
  const PlanSummary summary = plan.dynamics.summary();
  if (summary.multiplications + summary.additions == 0) return "";
  return std::to_string(summary.multiplications) + " multiplications, " +
         std::to_string(summary.additions) + " additions, " +
         std::to_string(summary.sines_and_cosines) + " sines and cosines";
}

}  // namespace virtual_work_dynamics
