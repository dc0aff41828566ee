#include "same_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kPi = 3.14159265358979323846;

enum Kind { kEffort, kForce, kMoment, kPosition, kTurn, kVelocity, kTurning, kKinds };

// A number's kind and value by its name.
using Numbers = std::map<std::string, std::pair<Kind, double>>;

class Collector {
 public:
  explicit Collector(Numbers& numbers) : numbers_(numbers) {}

  void add(Kind kind, const std::string& name, const double* values, int count) {
    for (int i = 0; i < count; ++i) {
      numbers_[name + ' ' + std::to_string(kind) + ' ' + std::to_string(i)] = {kind, values[i]};
    }
  }
  void add(const std::string& name, const Wrench& wrench) {
    add(kForce, name, wrench.force.data(), 3);
    add(kMoment, name, wrench.torque.data(), 3);
  }

 private:
  Numbers& numbers_;
};

Numbers numbersOf(const NamedPlan& plan, const Workspace& workspace) {
  Numbers numbers;
  Collector collector(numbers);
  const Request& request = plan.dynamics.request();
  for (Eigen::Index i = 0; i < workspace.effort().size(); ++i) {
    collector.add(kEffort, plan.coordinates[i], &workspace.effort()[i], 1);
  }
  for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
    collector.add("child axes " + request.child_axes[i], workspace.childAxes()[i]);
  }
  for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
    const std::string name = "root axes " + request.root_axes[i];
    collector.add(name, workspace.rootAxes()[i]);
    if (request.poses) {
      collector.add(kPosition, name, workspace.poses()[i].position.data(), 3);
      collector.add(kTurn, name, workspace.poses()[i].orientation.coeffs().data(), 4);
    }
    if (request.twists) {
      collector.add(kVelocity, name, workspace.twists()[i].linear.data(), 3);
      collector.add(kTurning, name, workspace.twists()[i].angular.data(), 3);
    }
  }
  return numbers;
}

// The motion that means the same to the other plan, whose coordinates may be more.
Motion translated(const Motion& motion, const NamedPlan& from, const NamedPlan& to) {
  Motion result(to.dynamics.coordinates());
  for (std::size_t i = 0; i < from.coordinates.size(); ++i) {
    const auto found = std::find(to.coordinates.begin(), to.coordinates.end(), from.coordinates[i]);
    if (found == to.coordinates.end()) throw Error("no coordinate '" + from.coordinates[i] + "'");
    const Eigen::Index k = found - to.coordinates.begin();
    const Eigen::Index n = static_cast<Eigen::Index>(i);
    result.q[k] = motion.q[n];
    result.qd[k] = motion.qd[n];
    result.qdd[k] = motion.qdd[n];
  }
  return result;
}

void checkFinite(const std::string& left_out, const Workspace& workspace) {
  if (!workspace.finite()) throw Error("without " + left_out + ": a result is not finite");
}

void compareState(const Numbers& numbers, const Numbers& others, Sameness& sameness) {
  std::array<double, kKinds> largest{};
  for (const auto& other : others) {
    double& of_kind = largest[other.second.first];
    of_kind = std::max(of_kind, std::abs(other.second.second));
  }
  for (const auto& number : numbers) {
    const auto other = others.find(number.first);
    if (other == others.end()) continue;
    ++sameness.numbers;
    const double a = number.second.second, b = other->second.second;
    if (a == b) continue;
    sameness.identical = false;
    // Where all others of a kind are zero, the difference itself has nothing to be measured by.
    const double scale = std::max(largest[number.second.first], std::abs(a));
    sameness.largest_difference = std::max(sameness.largest_difference, std::abs(a - b) / scale);
  }
}

}  // namespace

std::vector<Motion> randomStates(const NamedPlan& plan, std::size_t count) {
  std::mt19937 engine(3);
  // The standard's distributions give other numbers with another library.
  const auto uniform = [&engine](double range) {
    return range * (2 * (static_cast<double>(engine()) / 4294967296.0) - 1);
  };
  std::vector<Motion> states(count, Motion(plan.dynamics.coordinates()));
  for (Motion& motion : states) {
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      motion.q[i] = uniform(kPi);
      motion.qd[i] = uniform(2);
      motion.qdd[i] = uniform(5);
    }
  }
  return states;
}

Sameness compare(const Omission& omission, std::size_t count) {
  const NamedPlan& plan = *omission.plan;
  const NamedPlan& with = *omission.with;
  Workspace workspace = plan.dynamics.makeWorkspace();
  Workspace with_workspace = with.dynamics.makeWorkspace();
  Sameness sameness;
  for (const Motion& motion : randomStates(plan, count)) {
    Motion with_motion = translated(motion, plan, with);
    if (omission.with_at_rest) {
      with_motion.qd.setZero();
      with_motion.qdd.setZero();
    }
    plan.dynamics.compute(motion, workspace);
    with.dynamics.compute(with_motion, with_workspace);
    checkFinite(omission.left_out, workspace);
    checkFinite("nothing", with_workspace);
    compareState(numbersOf(plan, workspace), numbersOf(with, with_workspace), sameness);
  }
  if (sameness.numbers == 0) throw Error("without " + omission.left_out + ": nothing to compare");
  return sameness;
}

}  // namespace virtual_work_dynamics
