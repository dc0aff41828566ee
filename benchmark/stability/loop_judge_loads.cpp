#include "stability/loop_judge.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <cmath>
#include <limits>

#include "loops/cut_tree.h"
#include "newton_euler_oracle.h"
#include "virtual_work_dynamics/error_bound.h"

// How large the loads of a state are, by which errors are measured.

namespace virtual_work_dynamics {

long double LoopJudge::loadOf(const Motion& motion) const {
  ErrorBound bound(mechanism_, withoutLoops(scene_));
  bound.compute(motion, std::numeric_limits<double>::min());
  long double load = 0;
  for (const WrenchMagnitude& wrench : bound.wrenches()) {
    load = std::max({load, static_cast<long double>(wrench.force),
                     wrench.moment / static_cast<long double>(size_)});
  }
  for (std::size_t i = 0; i < bound.efforts().size(); ++i) {
    const Joint& joint = mechanism_.joints()[static_cast<std::size_t>(mechanism_.coordinates()[i])];
    const bool slides = joint.type == JointType::kPrismatic;
    load = std::max<long double>(load, bound.efforts()[i] / (slides ? 1 : size_));
  }
  return load;
}

// A spring pulls by a difference of lengths, which are differences of positions: what it would do
// over each of them. A damper does so by velocities.
long double LoopJudge::springLoadOf(const Motion& motion) const {
  if (scene_.springs.empty()) return 0;
  const NewtonEulerOracle bodies(mechanism_, withoutLoops(scene_), motion);
  long double load = 0;
  for (const PointSpring& spring : scene_.springs) {
    long double lengths = spring.rest_length, speeds = 0;
    const auto addEnd = [&](const std::string& name, const Eigen::Vector3d& at) {
      const int link = mechanism_.linkIndex(name);
      const Vector3l r = bodies.orientation(link) * at.cast<long double>();
      lengths += (bodies.origin(link) + r).norm();
      speeds += (bodies.originVelocity(link) + bodies.angularVelocity(link).cross(r)).norm();
    };
    addEnd(spring.link_a, spring.at_a);
    addEnd(spring.link_b, spring.at_b);
    if (scene_.static_motion) speeds = 0;
    load = std::max(load, spring.stiffness * lengths + spring.damping * speeds);
  }
  return load;
}

// Of a component that is not determined any value is exact: the one that was chosen counts.
long double LoopJudge::largestOf(const Exact& exact, const LoopComponents& computed) const {
  long double largest = 0;
  for (std::size_t i = 0; i < computed.size(); ++i) {
    const ExactComponent& right = exact.components[i];
    const long double value = right.determined() ? right.value : computed[i].value;
    if (!std::isfinite(value)) continue;
    largest = std::max(largest, std::abs(value) / (right.turns ? size_ : 1));
  }
  return largest;
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
