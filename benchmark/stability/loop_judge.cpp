#include "stability/loop_judge.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "loops/cut_tree.h"
#include "loops/link_kinematics.h"
#include "newton_euler_oracle.h"
#include "virtual_work_dynamics/error_bound.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Within this factor of the tolerances of rank and flags, either answer may be the right one.
constexpr double kUnclear = 100;
// The condition of the loops and that of the equations of all joints differ by the scaling of rows
// alone, in the scenes of the suite by less than three.
constexpr double kMostTrusted = 10;
// The exact system of a load that is borne is violated by rounding errors only.
constexpr double kBorne = 1e-12;
// A larger share of the load that nothing bears must be told.
constexpr double kNotBorne = 1e-7;
// Off by so much, rad or of the size, is what the completion starts from.
constexpr double kOffAtStart = 1e-3;
// Up to this condition a motion must be completed; the package gives up from 1e7 on, by the
// condition of the passive coordinates alone.
constexpr double kMustComplete = 1e5;

Request everythingOf(const std::vector<std::string>& names) {
  Request request;
  request.child_axes = request.root_axes = names;
  request.poses = true;
  return request;
}

std::vector<std::string> namesOf(const Mechanism& mechanism, const Scene& scene) {
  std::vector<std::string> names{kGround};
  for (const Joint& joint : mechanism.joints()) names.push_back(joint.name);
  for (const Closure& closure : scene.closures) names.push_back(closure.name);
  return names;
}

double finiteOrInfinity(long double value) {
  return std::isfinite(value) ? static_cast<double>(value) : kInfinity;
}

bool near(long double value, long double tolerance) {
  return value > tolerance / kUnclear && value < tolerance * kUnclear;
}

}  // namespace

void LoopVerdict::include(const LoopVerdict& other) {
  errors.include(other.errors);
  sensitivity = std::max(sensitivity, other.sensitivity);
  condition = std::max(condition, other.condition);
  rank = states == 0 ? other.rank : std::min(rank, other.rank);
  redundancy = std::max(redundancy, other.redundancy);
  redundant_constraints = std::max(redundant_constraints, other.redundant_constraints);
  free_motions = std::max(free_motions, other.free_motions);
  components = std::max(components, other.components);
  open = std::max(open, other.open);
  holds += other.holds;
  if (apart == 0) worst_apart = other.worst_apart;
  apart += other.apart;
  unborne = unborne || other.unborne;
  clear = clear && other.clear;
  residual = std::max(residual, other.residual);
  completed += other.completed;
  states += other.states;
}

LoopJudge::LoopJudge(const Mechanism& mechanism, const Scene& scene)
    : mechanism_(mechanism),
      scene_(scene),
      names_(namesOf(mechanism_, scene_)),
      dynamics_(mechanism_, scene_, everythingOf(names_)) {
  Motion rest(dynamics_.coordinates());
  rest.q = dynamics_.assembly();
  dynamics_.compute(rest);
  for (const Pose& pose : dynamics_.poses()) size_ = std::max(size_, pose.position.norm());
  if (size_ == 0) size_ = 1;
  const ErrorBound bound(mechanism_, withoutLoops(scene_));
  depth_ = *std::max_element(bound.depths().begin(), bound.depths().end());
  if (scene_.free_motion) countResidualsAsActuated();
}

Eigen::Index LoopJudge::residuals() const {
  return std::count(dynamics_.residual().begin(), dynamics_.residual().end(), true);
}

void LoopJudge::countResidualsAsActuated() {
  for (std::size_t i = 0; i < dynamics_.residual().size(); ++i) {
    if (dynamics_.residual()[i]) scene_.actuated->push_back(mechanism_.coordinateNames()[i]);
  }
}

LoopComponents LoopJudge::compute(const Motion& motion) {
  dynamics_.compute(motion);
  LoopComponents components;
  const auto put = [&](const Wrench& wrench, const Determined& determined,
                       const Determined& exist) {
    for (int i = 0; i < 6; ++i) {
      const auto place = static_cast<std::size_t>(i);
      components.push_back(
          {i < 3 ? wrench.force[i] : wrench.torque[i - 3], determined[place], exist[place]});
    }
  };
  for (std::size_t i = 0; i < names_.size(); ++i) {
    put(dynamics_.rootAxes()[i], dynamics_.rootAxesDetermined()[i], dynamics_.rootAxesExist()[i]);
    put(dynamics_.childAxes()[i], dynamics_.childAxesDetermined()[i],
        dynamics_.childAxesExist()[i]);
  }
  for (Eigen::Index i = 0; i < dynamics_.effort().size(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    components.push_back({dynamics_.effort()[i], dynamics_.effortDetermined()[place],
                          dynamics_.effortExists()[place]});
  }
  return components;
}

LoopJudge::Exact LoopJudge::exactOf(const Motion& motion) const {
  const MaximalCoordinatesOracle oracle(mechanism_, scene_, motion,
                                        scene_.redundancy.rank_tolerance);
  Exact exact;
  exact.length = oracle.length();
  const std::vector<long double> extents = extentsOf(motion);
  const auto put = [&](ExactComponent component, long double extent) {
    const long double size = std::abs(component.value);
    component.freedom_in_loop = component.freedom;
    if (component.turns && extent > 0) component.freedom_in_loop *= exact.length / extent;
    exact.components.push_back(component);
    if (!component.determined()) return;
    long double& largest = component.turns ? exact.moment : exact.force;
    largest = std::max(largest, size);
  };
  for (std::size_t k = 0; k < names_.size(); ++k) {
    for (const auto& reaction : {oracle.rootAxes(names_[k]), oracle.childAxes(names_[k])}) {
      for (int i = 0; i < 6; ++i) {
        put({reaction.wrench[i], reaction.freedom[static_cast<std::size_t>(i)], i >= 3},
            extents[k]);
      }
    }
  }
  for (std::size_t i = 0; i < mechanism_.coordinates().size(); ++i) {
    const Joint& joint = mechanism_.joints()[static_cast<std::size_t>(mechanism_.coordinates()[i])];
    const auto effort = oracle.effort(static_cast<int>(i));
    put({effort.value, effort.freedom, joint.type != JointType::kPrismatic},
        extents[indexOf(joint.name)]);
  }
  for (const std::string& name : dynamics_.actuatedClosures()) {
    const auto effort = oracle.closureEffort(name);
    put({effort.value, effort.freedom, !slides(name)}, extents[indexOf(name)]);
  }
  for (std::size_t c = 0; c < scene_.couplings.size(); ++c) {
    const std::string& first = scene_.couplings[c].terms.front().name;
    const auto effort = oracle.couplingEffort(c);
    const bool turns = mechanism_.joint(mechanism_.jointIndex(first)).type != JointType::kPrismatic;
    put({effort.value, effort.freedom, turns}, 0);
  }
  exact.redundancy = oracle.redundancy();
  exact.free_motions = oracle.freeMotions();
  exact.least_counted = oracle.leastCounted();
  exact.largest_left_out = oracle.largestLeftOut();
  exact.unborne = oracle.unborne();
  return exact;
}

std::size_t LoopJudge::indexOf(const std::string& name) const {
  return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
}

// By joint and closure the extent of the least loop that it is part of, m; zero where there is
// none. A loop whose origins are one point by the rank's tolerance has no extent.
std::vector<long double> LoopJudge::extentsOf(const Motion& motion) const {
  const NewtonEulerOracle bodies(mechanism_, withoutLoops(scene_), motion);
  std::vector<long double> least(names_.size(), 0);
  for (const Closure& closure : scene_.closures) {
    const Vector3l o = PlacedFrame(mechanism_, bodies, closure.child).o;
    long double extent = (PlacedFrame(mechanism_, bodies, closure.parent).o - o).norm();
    std::vector<std::size_t> loop{indexOf(closure.name)};
    for (const PathStep& step : pathBetween(mechanism_, mechanism_.linkIndex(closure.parent.link),
                                            mechanism_.linkIndex(closure.child.link))) {
      loop.push_back(indexOf(mechanism_.joint(step.joint).name));
      extent = std::max(extent, (bodies.origin(step.joint + 1) - o).norm());
    }
    if (extent <= scene_.redundancy.rank_tolerance * size_) continue;
    for (const std::size_t k : loop) least[k] = least[k] > 0 ? std::min(least[k], extent) : extent;
  }
  return least;
}

bool LoopJudge::slides(const std::string& closure) const {
  return std::any_of(scene_.closures.begin(), scene_.closures.end(), [&](const Closure& other) {
    return other.name == closure &&
           (other.type == ClosureType::kPrismatic || other.type == ClosureType::kCylinder);
  });
}

std::string LoopJudge::nameOf(std::size_t component) const {
  constexpr std::array<const char*, 6> kComponents = {"fx", "fy", "fz", "tx", "ty", "tz"};
  const std::size_t wrench = component / 6, in_child_axes = wrench % 2;
  if (wrench >= 2 * names_.size()) {
    std::vector<std::string> efforts = mechanism_.coordinateNames();
    for (const std::string& name : dynamics_.actuatedClosures()) efforts.push_back(name);
    for (const Coupling& coupling : scene_.couplings) efforts.push_back(coupling.name);
    return "effort of " + efforts.at(component - 12 * names_.size());
  }
  return kComponents[component % 6] +
         std::string(in_child_axes ? " in child axes of " : " in root axes of ") +
         names_[wrench / 2];
}

LoopVerdict LoopJudge::compare(const Motion& motion, const LoopComponents& computed,
                               const Determinacy& found) const {
  const Exact exact = exactOf(motion);
  LoopVerdict verdict;
  verdict.condition = found.condition;
  verdict.rank = found.rank;
  verdict.redundancy = found.redundancy;
  verdict.redundant_constraints = found.redundant_constraints;
  verdict.free_motions = found.free_motions;
  verdict.components = static_cast<int>(computed.size());
  verdict.states = 1;
  verdict.unborne = exact.free_motions > 0 && exact.unborne > kBorne;
  compareCountsAndFlags(exact, computed, found, verdict);
  const long double scale = 4 * (depth_ + found.rank + found.redundancy) *
                            (loadOf(motion) + springLoadOf(motion) + largestOf(exact, computed));
  compareValues(exact, computed, scale, lossOf(exact, found), verdict);
  return verdict;
}

void LoopJudge::compareCountsAndFlags(const Exact& exact, const LoopComponents& computed,
                                      const Determinacy& found, LoopVerdict& verdict) const {
  const long double tolerance = scene_.redundancy.rank_tolerance;
  verdict.clear = !near(exact.least_counted, tolerance) && !near(exact.largest_left_out, tolerance);
  const auto differs = [&](const std::string& what) {
    if (verdict.clear && verdict.apart++ == 0) verdict.worst_apart = what;
  };
  if (found.redundancy != exact.redundancy) {
    differs("redundancy of " + std::to_string(exact.redundancy));
  }
  if (found.free_motions != exact.free_motions) {
    differs(std::to_string(exact.free_motions) + " free motions");
  }
  for (std::size_t i = 0; i < computed.size(); ++i) {
    const ExactComponent& right = exact.components[i];
    if (!computed[i].determined) ++verdict.open;
    // A load that a singular position does not bear leaves more open than the null space does.
    const bool borne = found.free_motions == 0 || exact.unborne <= kBorne;
    const bool may_be_open = !borne && right.determined();
    if (computed[i].determined != right.determined() && !may_be_open && !right.isOfTinyLoop() &&
        !near(right.freedom, MaximalCoordinatesOracle::kFree)) {
      differs("flag of " + nameOf(i));
    }
    if (!computed[i].exists && borne && (exact.free_motions == 0 || right.determined())) {
      differs("existence of " + nameOf(i));
    }
  }
  const bool all_exist =
      std::all_of(computed.begin(), computed.end(),
                  [](const LoopComponent& component) { return component.exists; });
  if (all_exist && exact.unborne > kNotBorne) differs("existence of what nothing bears");
}

// What a step of the computation loses: eps and what the rank leaves out, times the condition.
long double LoopJudge::lossOf(const Exact& exact, const Determinacy& found) const {
  const long double condition =
      std::min<long double>(found.condition, kMostTrusted / exact.least_counted);
  return condition * (kEps + exact.largest_left_out + exact.unborne);
}

void LoopJudge::compareValues(const Exact& exact, const LoopComponents& computed, long double scale,
                              long double loss, LoopVerdict& verdict) const {
  const bool same_rank =
      verdict.redundancy == exact.redundancy && verdict.free_motions == exact.free_motions;
  const bool comparable = same_rank && (exact.free_motions == 0 || exact.unborne <= kBorne);
  for (std::size_t i = 0; i < computed.size(); ++i) {
    const ExactComponent& right = exact.components[i];
    if (!(comparable && computed[i].determined) && std::isfinite(computed[i].value)) continue;
    const long double error = std::abs(computed[i].value - right.value);
    const long double bound =
        (loss * (right.turns ? size_ : 1) + right.freedom * (right.turns ? exact.length : 1)) *
        scale;
    const double over_bound = finiteOrInfinity(error / bound);
    if (over_bound > verdict.errors.over_bound) {
      verdict.errors.over_bound = over_bound;
      verdict.errors.worst = nameOf(i);
    }
    const long double largest = right.turns ? exact.moment : exact.force;
    if (largest == 0 || !right.determined()) continue;
    verdict.errors.relative = std::max(verdict.errors.relative, finiteOrInfinity(error / largest));
  }
}

double LoopJudge::sensitivity(const Motion& motion, const Motion& moved) const {
  const Exact here = exactOf(motion), there = exactOf(moved);
  double most = 0;
  for (std::size_t i = 0; i < here.components.size(); ++i) {
    const ExactComponent &a = here.components[i], &b = there.components[i];
    const long double largest = a.turns ? here.moment : here.force;
    if (!a.determined() || !b.determined() || largest == 0) continue;
    most = std::max(most, finiteOrInfinity(std::abs(b.value - a.value) / largest));
  }
  return most;
}

void LoopJudge::complete(const Motion& motion, double limit, RandomNumbers& random,
                         LoopVerdict& verdict) {
  Motion start = motion;
  for (Eigen::Index i = 0; i < start.q.size(); ++i) {
    if (dynamics_.actuated()[static_cast<std::size_t>(i)]) continue;
    const int joint = mechanism_.coordinates()[static_cast<std::size_t>(i)];
    const bool slides =
        mechanism_.joints()[static_cast<std::size_t>(joint)].type == JointType::kPrismatic;
    start.q[i] += random.uniform(-kOffAtStart, kOffAtStart) * (slides ? size_ : 1);
    start.qd[i] = start.qdd[i] = 0;
  }
  if (!dynamics_.complete(start)) {
    if (verdict.condition > kMustComplete || verdict.free_motions > 0) return;
    if (verdict.apart++ == 0) verdict.worst_apart = "a motion that is not completed";
    return;
  }
  ++verdict.completed;
  dynamics_.compute(start);
  for (const ClosureResidual& residual : dynamics_.relativeResiduals()) {
    for (const double level : {residual.position, residual.velocity, residual.acceleration}) {
      verdict.residual = std::max(verdict.residual, finiteOrInfinity(level / limit));
    }
  }
}

LoopVerdict LoopJudge::judgeForces(const Motion& motion) {
  const LoopComponents computed = compute(motion);
  LoopVerdict verdict = compare(motion, computed, determinacy());
  if (!dynamics_.results().loops.holds.empty()) {
    const Exact exact = exactOf(motion);
    compareHolds(exact, largestOf(exact, computed), verdict);
  }
  return verdict;
}

LoopVerdict LoopJudge::judge(const Motion& motion, RandomNumbers& random) {
  LoopVerdict verdict = judgeForces(motion);
  complete(motion, 4 * kEps * (depth_ + verdict.rank + verdict.redundancy), random, verdict);
  return verdict;
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
