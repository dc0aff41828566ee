#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "property_check.h"

// At a position, results are an affine function of gravity, of the applied wrenches and of the
// accelerations; of the velocities, a quadratic one. Springs are constant, and damping is what is
// linear in the velocities. Dry friction is neither and is left out.
namespace virtual_work_dynamics {
namespace {

using Sum = std::vector<std::pair<long double, const Outcome*>>;  // factors and what they multiply

template <typename Get>
auto total(const Sum& sum, Get get) {
  decltype(get(*sum[0].second)) result;
  for (const auto& [factor, outcome] : sum) result = result + factor * get(*outcome);
  return result;
}

void compareEfforts(const Sum& a, const Sum& b, Agreement& agreement) {
  for (const std::string& name : a[0].second->coordinates()) {
    const auto effort = [&](const Outcome& outcome) { return outcome.effort(name); };
    agreement.compare("effort of " + name, total(a, effort), total(b, effort));
  }
}

void compareReactions(const Sum& a, const Sum& b, Agreement& agreement) {
  for (const std::string& name : a[0].second->reactions()) {
    const auto child = [&](const Outcome& outcome) { return outcome.child(name); };
    const auto root = [&](const Outcome& outcome) { return outcome.root(name); };
    agreement.compare("child axes of " + name, total(a, child), total(b, child));
    agreement.compare("root axes of " + name, total(a, root), total(b, root));
  }
}

void compareSums(const Sum& a, const Sum& b, Agreement& agreement) {
  compareEfforts(a, b, agreement);
  compareReactions(a, b, agreement);
}

Case moving(RandomCases& random) {
  Case made = random.next(2 + random.pick(11));
  made.scene.static_motion = false;
  made.scene.use_urdf_dynamics = false;
  for (JointTerms& terms : made.scene.joints) terms.coulomb = 0;
  return made;
}

// Parts of a case: what is not taken is zero.
struct Parts {
  bool gravity, wrenches, velocities, accelerations;
};

Case only(const Parts& parts, Case made) {
  if (!parts.gravity) made.scene.gravity.setZero();
  if (!parts.velocities) made.motion.qd.setZero();
  if (!parts.accelerations) made.motion.qdd.setZero();
  for (AppliedWrench& applied : made.scene.applied_wrenches) {
    if (parts.wrenches) continue;
    applied.force.setZero();
    applied.torque.setZero();
  }
  return made;
}

TEST(PropertyOfSuperposition, PartsAddUp) {
  checkProperty(20000000, [](RandomCases& random, Agreement& agreement) {
    const Case made = moving(random);
    agreement.begin({made});
    const Outcome all(made), none(only({false, false, false, false}, made)),
        gravity(only({true, false, false, false}, made)),
        wrenches(only({false, true, false, false}, made)),
        velocities(only({false, false, true, false}, made)),
        accelerations(only({false, false, false, true}, made));
    compareSums({{1, &all}, {3, &none}},
                {{1, &gravity}, {1, &wrenches}, {1, &velocities}, {1, &accelerations}}, agreement);
  });
}

// Compares f(a x + y) - f(0) with a (f(x) - f(0)) + (f(y) - f(0)).
void compareLinear(const Case& zero, const Case& x, const Case& y, double a, const Case& ax_y,
                   Agreement& agreement) {
  agreement.begin({zero, x, y, ax_y});
  const Outcome of_zero(zero), of_x(x), of_y(y), of_ax_y(ax_y);
  compareSums({{1, &of_ax_y}, {static_cast<long double>(a), &of_zero}}, {{a, &of_x}, {1, &of_y}},
              agreement);
}

TEST(PropertyOfSuperposition, ResultsAreLinearInGravityAndAppliedWrenches) {
  checkProperty(21000000, [](RandomCases& random, Agreement& agreement) {
    const Case x = moving(random), zero = only({false, false, true, true}, x);
    Case y = x, ax_y = x;
    const double a = random.uniform(-2, 2);
    y.scene.gravity = random.doubles(10);
    ax_y.scene.gravity = a * x.scene.gravity + y.scene.gravity;
    for (std::size_t i = 0; i < x.scene.applied_wrenches.size(); ++i) {
      const AppliedWrench& of_x = x.scene.applied_wrenches[i];
      AppliedWrench& of_y = y.scene.applied_wrenches[i];
      of_y.force = random.doubles(20);
      of_y.torque = random.doubles(5);
      ax_y.scene.applied_wrenches[i].force = a * of_x.force + of_y.force;
      ax_y.scene.applied_wrenches[i].torque = a * of_x.torque + of_y.torque;
    }
    compareLinear(zero, x, y, a, ax_y, agreement);
  });
}

TEST(PropertyOfSuperposition, ResultsAreLinearInAccelerations) {
  checkProperty(22000000, [](RandomCases& random, Agreement& agreement) {
    const Case x = moving(random), zero = only({true, true, true, false}, x);
    Case y = x, ax_y = x;
    const double a = random.uniform(-2, 2);
    y.motion.qdd = random.motion(x.mechanism).qdd;
    ax_y.motion.qdd = a * x.motion.qdd + y.motion.qdd;
    compareLinear(zero, x, y, a, ax_y, agreement);
  });
}

Case withVelocities(Case made, const Eigen::VectorXd& qd) {
  made.motion.qd = qd;
  return made;
}

// A function whose even part obeys the parallelogram law is quadratic there; its odd part is what
// damping does to efforts.
TEST(PropertyOfSuperposition, ResultsAreQuadraticInVelocities) {
  checkProperty(23000000, [](RandomCases& random, Agreement& agreement) {
    const Case made = moving(random);
    agreement.begin({made});
    const Eigen::VectorXd u = made.motion.qd, v = random.motion(made.mechanism).qd;
    const double a = random.uniform(0.1, 3);
    const auto at = [&](const Eigen::VectorXd& qd) { return Outcome(withVelocities(made, qd)); };
    const Outcome zero = at(0 * u), plus = at(u), minus = at(-u), other = at(v), back = at(-v);
    const Outcome far = at(a * u), far_back = at(-a * u);
    const long double a_2 = static_cast<long double>(a) * a;
    compareSums({{1, &far}, {1, &far_back}, {2 * a_2, &zero}},
                {{a_2, &plus}, {a_2, &minus}, {2, &zero}}, agreement);
    compareReactions({{1, &plus}}, {{1, &minus}}, agreement);
    compareEfforts({{1, &far}, {a, &minus}}, {{1, &far_back}, {a, &plus}}, agreement);

    const Outcome sum = at(u + v), sum_back = at(-u - v), difference = at(u - v),
                  difference_back = at(v - u);
    compareSums({{1, &sum}, {1, &sum_back}, {1, &difference}, {1, &difference_back}, {4, &zero}},
                {{2, &plus}, {2, &minus}, {2, &other}, {2, &back}}, agreement);
  });
}

TEST(PropertyOfSuperposition, AStaticSceneIsOneAtRest) {
  checkProperty(24000000, [](RandomCases& random, Agreement& agreement) {
    Case made = moving(random);
    const Case rest = only({true, true, false, false}, made);
    made.scene.static_motion = true;
    agreement.begin({made, rest});
    const Outcome in_static_scene(made), at_rest(rest);
    compareSums({{1, &in_static_scene}}, {{1, &at_rest}}, agreement);
  });
}

}  // namespace
}  // namespace virtual_work_dynamics
