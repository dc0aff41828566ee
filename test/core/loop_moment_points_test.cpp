#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "maximal_coordinates_oracle.h"
#include "moment_points.h"
#include "named_loop_results.h"
#include "random_loops.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest component of the sample, for each unit of the condition.
constexpr double kPerCondition = 200 * 2.2e-16;
constexpr int kCases = 250;

double toleranceOf(const NamedLoopResults& results) {
  double largest = 1;
  for (const std::string& name : results.names()) {
    for (int i = 0; i < 6; ++i) {
      largest = std::max(largest, std::abs(component(results.rootAxes(name), i)));
    }
  }
  return kPerCondition * std::max(1.0, results.dynamics().determinacy().condition) * largest;
}

class LoopMomentPoints : public testing::Test {
 protected:
  // Random loops that their actuated joints hold, with points for the moments of all reactions.
  template <typename Check>
  void forEachCase(unsigned seed, Check check) {
    RandomLoops loops(seed);
    RandomCases random(seed + 1);
    int checked = 0;
    for (int n = 0; n < kCases; ++n) {
      SCOPED_TRACE("case " + std::to_string(n));
      Case made = loops.next();
      const MaximalCoordinatesOracle oracle(made.mechanism, made.scene, made.motion);
      if (oracle.freeMotions() > 0) continue;
      ++checked;
      const NewtonEulerOracle bodies(made.mechanism, bare(made.scene), made.motion);
      check(made, oracle, bodies, random);
    }
    EXPECT_GE(checked, kCases / 3);
  }

  static Scene bare(Scene scene) {
    scene.closures.clear();
    scene.springs.clear();
    return scene;
  }

  void expectSame(const MaximalCoordinatesOracle::Reaction& expected, const Wrench& wrench,
                  const Determined& determined, double tolerance, const std::string& name) {
    EXPECT_EQ(determined, expected.determined) << name;
    for (int i = 0; i < 6; ++i) {
      EXPECT_TRUE(std::isfinite(component(wrench, i))) << name;
      if (!expected.determined[static_cast<std::size_t>(i)]) continue;
      EXPECT_NEAR(component(wrench, i), static_cast<double>(expected.wrench[i]), tolerance)
          << name << ", component " << i;
    }
  }
};

// Which components are determined depends on the point: a force that is open makes the moment about
// every other point open.
TEST_F(LoopMomentPoints, ValuesAndFlagsAreThoseOfTheEquationsOfAllJoints) {
  int other_flags = 0;
  forEachCase(91, [&](Case& made, const MaximalCoordinatesOracle& oracle,
                      const NewtonEulerOracle& bodies, RandomCases& random) {
    made.scene.moments_about = randomMomentPoints(random, made.mechanism, made.scene);
    const NamedLoopResults results(made.mechanism, made.scene, made.motion);
    const double tolerance = toleranceOf(results);
    for (const MomentPoint& point : made.scene.moments_about) {
      const std::string& name = point.name;
      const Vector3l place = placeOf(made.mechanism, made.scene, bodies, point);
      expectSame(oracle.rootAxesAbout(name, place), results.rootAxes(name),
                 results.rootAxesDetermined(name), tolerance, name);
      expectSame(oracle.childAxesAbout(name, place), results.childAxes(name),
                 results.childAxesDetermined(name), tolerance, name);
      other_flags += oracle.rootAxes(name).determined != results.rootAxesDetermined(name);
    }
  });
  EXPECT_GE(other_flags, 50);
}

// With all moments about one point, those on a link are added as they are: their sum is what the
// link needs about that point.
TEST_F(LoopMomentPoints, MomentsAboutOnePointAddUpToWhatEachLinkNeeds) {
  forEachCase(92, [&](Case& made, const MaximalCoordinatesOracle&, const NewtonEulerOracle& bodies,
                      RandomCases& random) {
    const Mechanism& mechanism = made.mechanism;
    const Eigen::Vector3d at = random.doubles(0.5);
    for (const std::string& name : NamedLoopResults::namesOf(mechanism, made.scene)) {
      if (name == kGround) continue;
      made.scene.moments_about.push_back(
          {name, JointFrame::kChild, mechanism.links().front().name, at});
    }
    const NamedLoopResults results(mechanism, made.scene, made.motion);
    std::vector<Vector3l> left(mechanism.links().size(), Vector3l::Zero());
    const auto add = [&](const std::string& name, int parent, int child) {
      const Vector3l moment = results.rootAxes(name).torque.cast<long double>();
      left[static_cast<std::size_t>(child)] += moment;
      left[static_cast<std::size_t>(parent)] -= moment;
    };
    for (const Joint& joint : mechanism.joints())
      add(joint.name, joint.parent_link, joint.child_link);
    for (const Closure& closure : made.scene.closures) {
      add(closure.name, mechanism.linkIndex(closure.parent.link),
          mechanism.linkIndex(closure.child.link));
    }
    const Vector3l place = at.cast<long double>();  // the root link's axes are the root's
    for (const PointSpring& spring : made.scene.springs) {
      const SpringForce pull(mechanism, bodies, spring);
      left[static_cast<std::size_t>(mechanism.linkIndex(spring.link_a))] +=
          (pull.a - place).cross(pull.force_on_a);
      left[static_cast<std::size_t>(mechanism.linkIndex(spring.link_b))] -=
          (pull.b - place).cross(pull.force_on_a);
    }
    for (std::size_t link = 1; link < left.size(); ++link) {
      const auto need = bodies.demand(static_cast<int>(link));
      left[link] -=
          need.torque + (bodies.centreOfMass(static_cast<int>(link)) - place).cross(need.force);
      EXPECT_LE(left[link].norm(), 10 * toleranceOf(results)) << mechanism.links()[link].name;
    }
  });
}

// Poses and twists of closures go with the point, and the power of the reaction stays.
TEST_F(LoopMomentPoints, PowerOfAReactionDoesNotDependOnThePoint) {
  forEachCase(93, [&](Case& made, const MaximalCoordinatesOracle&, const NewtonEulerOracle& bodies,
                      RandomCases& random) {
    Request request;
    request.root_axes = NamedLoopResults::namesOf(made.mechanism, made.scene);
    request.poses = request.twists = true;
    ClosedLoops plain(made.mechanism, made.scene, request);
    plain.compute(made.motion);
    made.scene.moments_about = randomMomentPoints(random, made.mechanism, made.scene);
    ClosedLoops moved(made.mechanism, made.scene, request);
    moved.compute(made.motion);
    const auto power = [](const ClosedLoops& loops, std::size_t i) {
      return loops.rootAxes()[i].force.dot(loops.twists()[i].linear) +
             loops.rootAxes()[i].torque.dot(loops.twists()[i].angular);
    };
    for (std::size_t i = 1; i < request.root_axes.size(); ++i) {
      const double size = 1 + plain.rootAxes()[i].force.norm() + plain.rootAxes()[i].torque.norm();
      EXPECT_NEAR(power(moved, i), power(plain, i), 1e-11 * size) << request.root_axes[i];
      const MomentPoint& point = made.scene.moments_about[i - 1];
      const Vector3l place = placeOf(made.mechanism, made.scene, bodies, point);
      EXPECT_LE((moved.poses()[i].position.cast<long double>() - place).norm(), 1e-13)
          << request.root_axes[i];
    }
  });
}

}  // namespace
}  // namespace virtual_work_dynamics
