#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "held_mechanisms.h"
#include "maximal_coordinates_oracle.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
// The rank's tolerance, and the band below which rounding of positions may decide for either side.
constexpr double kTolerance = 1e-10, kBand = 3;

// Compares every effort and component of a reaction that is determined with the equations of all
// joints, and the flags with theirs; lengths are about one.
void expectDetermined(const Held& held, const ClosedLoopResults& results, double bound) {
  const MaximalCoordinatesOracle oracle(held.mechanism, held.scene, Motion(1));
  ASSERT_EQ(oracle.freeMotions(), 0);
  int compared = 0;
  const auto expectSame = [&](const MaximalCoordinatesOracle::Reaction& expected,
                              const Wrench& wrench, const Determined& determined) {
    for (int i = 0; i < 6; ++i) {
      const auto place = static_cast<std::size_t>(i);
      EXPECT_EQ(determined[place], expected.determined[place]) << i;
      if (!expected.determined[place]) continue;
      ++compared;
      EXPECT_NEAR(i < 3 ? wrench.force[i] : wrench.torque[i - 3],
                  static_cast<double>(expected.wrench[i]), bound)
          << i;
    }
  };
  for (const std::string& name : results.dynamics.request().root_axes) {
    SCOPED_TRACE(name);
    expectSame(oracle.rootAxes(name), results.root(name), results.rootDetermined(name));
    expectSame(oracle.childAxes(name), results.child(name), results.childDetermined(name));
  }
  EXPECT_GE(compared, 4);
  EXPECT_TRUE(results.dynamics.effortDetermined()[0]);
  EXPECT_NEAR(results.dynamics.effort()[0], static_cast<double>(oracle.effort(0).value), bound);
}

// Condition is size over lever, however few coordinates there are; what is determined is right to
// rounding times the condition; and once the rank is gone the mechanism is refused or flagged.
TEST(LoopRank, ConditionGrowsWithTheInverseOfTheLeverUntilTheRankIsGone) {
  for (const auto& make : kHeldMechanisms) {
    int computed = 0, gone = 0;
    for (double y = 1; y > 0.9e-14; y /= 10) {
      const Held held = make(y);
      SCOPED_TRACE(held.name + ", y = " + std::to_string(std::log10(y)));
      const double left = held.lever / held.size;
      try {
        const ClosedLoopResults results(held.mechanism, held.scene, Motion(1));
        if (results.dynamics.results().singular()) {
          EXPECT_LT(left, kBand * kTolerance);
          EXPECT_FALSE(results.dynamics.effortExists()[0]);
          ++gone;
          continue;
        }
        ++computed;
        EXPECT_GT(left, kTolerance / kBand);
        const double condition = results.dynamics.determinacy().condition;
        EXPECT_NEAR(condition * left, 1, y < 0.02 ? 1e-3 : 0.5);
        // L = 1 joint, n = 2 bodies.
        const double expected = held.load / held.lever;
        const double bound = 4 * (1 + 2) * kEps * condition * (expected + kHeldGravity);
        EXPECT_NEAR(held.bearing(results), expected, bound);
        expectDetermined(held, results, bound);
      } catch (const SceneError& error) {
        EXPECT_LT(left, kBand * kTolerance) << error.what();
        EXPECT_NE(std::string(error.what()).find("nothing holds the motion of 'joint_1'"),
                  std::string::npos)
            << error.what();
        ++gone;
      }
    }
    EXPECT_GE(computed, 9);
    EXPECT_GE(gone, 4);
  }
}

/// An arm in a random place, whose rod ends `beside` its axis in units of the arm's size.
struct RandomArm {
  RandomArm(std::mt19937& generator, double beside) : scene() {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&]() {
      return Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator));
    };
    const double size = std::pow(10, 3 * uniform(generator));
    RobotBuilder builder(1);
    const Eigen::Vector3d axis = vector().normalized(), place = size * vector();
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(3 * uniform(generator), vector().normalized()).toRotationMatrix();
    builder.add(JointType::kContinuous, 0, axis.cast<long double>(), R.cast<long double>(),
                place.cast<long double>());
    builder.removeInertia(1);
    builder.link(1).mass = 2;
    builder.link(1).p_KoCm_K = (size * vector()).cast<long double>();
    mechanism = std::make_unique<Mechanism>(builder.build());
    const Eigen::Vector3d normal = axis.cross(vector()).normalized();
    Eigen::Vector3d on_arm = size * uniform(generator) * axis + beside * size * normal;
    Eigen::Vector3d on_base = place + size * (2 * vector() + Eigen::Vector3d(0, 0, 4));
    if (uniform(generator) < 0) {  // the end that lies on the axis is that on the base
      std::swap(on_arm, on_base);
      on_arm = R.transpose() * (on_arm - place);
      on_base = place + R * on_base;
    }
    scene.closures = {
        closureOf(ClosureType::kDistance, frameAt("link_1", on_arm), frameAt("link_0", on_base))};
    if (uniform(generator) < 0) std::swap(scene.closures[0].parent, scene.closures[0].child);
    scene.actuated.emplace();
  }

  std::unique_ptr<Mechanism> mechanism;
  Scene scene;
};

// The rod's end turns with the arm or lies on its axis: the rod cannot hold it.
TEST(LoopRank, ARodToTheAxisHoldsNothing) {
  constexpr int kPlacements = 200;
  std::mt19937 generator(3);
  int refused = 0, accepted = 0;
  for (int i = 0; i < kPlacements; ++i) {
    const RandomArm arm(generator, 0);
    try {
      ClosedLoopResults(*arm.mechanism, arm.scene);
    } catch (const SceneError& error) {
      EXPECT_EQ(std::string(error.what()),
                "actuated: too few for the degrees of freedom: nothing holds the motion of "
                "'joint_1' (free_motion: true reports what that motion demands)");
      ++refused;
    }
  }
  for (int i = 0; i < kPlacements; ++i) {
    const RandomArm arm(generator, 1e-3);
    EXPECT_NO_THROW(ClosedLoopResults(*arm.mechanism, arm.scene));
    ++accepted;
  }
  EXPECT_EQ(refused, kPlacements);
  EXPECT_EQ(accepted, kPlacements);
}

// All origins on the loop are one point except for rounding errors, which are no size of a loop to
// judge its closing by.
TEST(LoopRank, RoundingErrorsAreNotTheSizeOfALoop) {
  constexpr unsigned kPlacements = 200;
  for (unsigned seed = 1; seed <= kPlacements; ++seed) {
    RobotBuilder builder(seed);
    builder.add(JointType::kContinuous, 0, builder.direction(), builder.rotation(),
                builder.vector(1));
    const Vector3l axis = builder.direction(), origin = builder.vector(1);
    const Matrix3l R = builder.rotation();
    builder.add(JointType::kPrismatic, 1, axis, R, origin);
    const double slide = builder.uniform(-1, 1);
    Scene scene;
    const Vector3l there = origin + slide * (R * axis);
    scene.closures = {closureOf(ClosureType::kSpherical, frameAt("link_2", {0, 0, 0}),
                                frameAt("link_1", there.cast<double>()))};
    scene.assembly = {{"joint_1", 0.7}, {"joint_2", slide}};
    EXPECT_NO_THROW(ClosedLoopResults(builder.build(), scene)) << seed;
  }
}

// A ball on an arm's axis holds the arm by what positions are rounded by, if by anything: 1e-13 of
// the size of the other loop is nothing, and 1e-7 is a lever.
TEST(LoopRank, ALoopOfOnePointIsHeldByMoreThanRoundingErrors) {
  for (const double beside : {0.0, 1e-16, 1e-13, 1e-11, 1e-7, 1e-5, 1e-3}) {
    for (const double size : {1e-6, 1.0, 1e6}) {
      SCOPED_TRACE(beside * size);
      RobotBuilder builder(2);
      const Vector3l z = Vector3l::UnitZ(), out(size, 0, 0);
      builder.add(JointType::kContinuous, 0, z, Matrix3l::Identity(), Vector3l::Zero());
      builder.add(JointType::kContinuous, 1, Vector3l::UnitY(), Matrix3l::Identity(), out);
      Scene scene;
      Closure hinge = closureOf(ClosureType::kRevolute, frameAt("link_0", {0, 0, size}),
                                frameAt("link_1", {0, 0, size}));
      hinge.name = "hinge";
      const Eigen::Vector3d ball(0, 0, beside * size);
      scene.closures = {hinge, closureOf(ClosureType::kSpherical, frameAt("link_2", ball),
                                         frameAt("link_1", out.cast<double>() + ball))};
      scene.actuated = std::vector<std::string>{"joint_1"};
      const Mechanism mechanism = builder.build();
      if (beside > 1e-10) {
        const ClosedLoopResults results(mechanism, scene, Motion(2));
        EXPECT_FALSE(results.dynamics.results().singular());
      } else {
        EXPECT_THROW(ClosedLoopResults(mechanism, scene), SceneError);
      }
    }
  }
}

// Other loops, units and the joint that is cut change neither rank nor condition.
TEST(LoopRank, DoesNotDependOnOtherLoops) {
  for (const double y : {1e-3, 1e-8, 3e-10, 3e-11}) {
    RobotBuilder builder(1);
    Scene scene;
    scene.actuated.emplace();
    for (int i = 0; i < 4; ++i) {
      const double size = std::pow(10, -i);
      builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), Matrix3l::Identity(),
                  Vector3l(0, 0, i));
      const std::string link = "link_" + std::to_string(i + 1);
      Closure closure = closureOf(ClosureType::kDistance, frameAt(link, {size, 0, 0}),
                                  frameAt("link_0", {2 * size, 2 * y * size, double(i)}));
      closure.name = "rod_" + std::to_string(i);
      Scene alone = scene;
      scene.closures.push_back(closure);
      alone.closures = {closure};
      const Motion motion(i + 1);
      if (i > 0) continue;
      const ClosedLoopResults one(builder.build(), alone, motion);
      EXPECT_EQ(one.dynamics.results().singular(), y < kTolerance);
    }
    const ClosedLoopResults results(builder.build(), scene, Motion(4));
    EXPECT_EQ(results.dynamics.determinacy().free_motions, y < kTolerance ? 4 : 0);
    if (y < kTolerance) continue;
    for (const double condition : results.dynamics.closureConditions()) {
      EXPECT_NEAR(condition * y, 1, 1e-3);
    }
  }
}

// Completed motions leave closed what rounding lets them, from any start close by.
TEST(LoopRank, CompletedPositionsAreClosedToRounding) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-1e-3, 1e-3);
  for (const auto& make : kHeldMechanisms) {
    for (const double y : {1.0, 1e-1, 1e-2}) {
      const Held held = make(y);
      SCOPED_TRACE(held.name + ", y = " + std::to_string(y));
      ClosedLoopResults results(held.mechanism, held.scene, Motion(1));
      const Determinacy determinacy = results.dynamics.determinacy();
      // L = 1 joint, n unknowns of the loop.
      const double limit = 4 * kEps * (1 + determinacy.rank + determinacy.redundancy);
      for (int n = 0; n < 40; ++n) {
        Motion motion(1);
        motion.q[0] = off(random) * y;
        ASSERT_TRUE(results.dynamics.complete(motion));
        results.dynamics.compute(motion);
        for (const ClosureResidual& residual : results.dynamics.relativeResiduals()) {
          EXPECT_LE(residual.position, limit);
        }
      }
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
