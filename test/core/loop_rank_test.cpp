#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "closed_loop_results.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kGravity = 9.81;
// The rank's tolerance, and the band below which rounding of positions may decide for either side.
constexpr double kTolerance = 1e-10, kBand = 3;

LinkFrame frameAt(const std::string& link, const Eigen::Vector3d& xyz) {
  LinkFrame frame;
  frame.link = link;
  frame.xyz = xyz;
  return frame;
}

Closure closureOf(ClosureType type, const LinkFrame& parent, const LinkFrame& child) {
  Closure closure;
  closure.name = "closure";
  closure.type = type;
  closure.parent = parent;
  closure.child = child;
  return closure;
}

/// A mechanism with one passive coordinate at zero and a closure that holds it with a lever, or a
/// slope, of y.
struct Held {
  std::string name;
  Mechanism mechanism;
  Scene scene;
  double size;   // of a row without cancellation, over the length
  double lever;  // what is left of it
  std::function<double(const ClosedLoopResults&)> bearing;  // what balances the load
  double load;
};

RobotBuilder armOf(JointType type, const Vector3l& axis, const Vector3l& centre) {
  RobotBuilder builder(1);
  builder.add(type, 0, axis, Matrix3l::Identity(), Vector3l::Zero());
  builder.removeInertia(1);
  builder.link(1).mass = 1;
  builder.link(1).p_KoCm_K = centre;
  return builder;
}

Scene sceneOf(const Eigen::Vector3d& gravity, const Closure& closure) {
  Scene scene;
  scene.gravity = gravity;
  scene.closures = {closure};
  scene.actuated.emplace();
  return scene;
}

double forceAlong(const ClosedLoopResults& results, const Eigen::Vector3d& direction) {
  return std::abs(results.root("closure").force.dot(direction));
}

// The arm's rod points from its end (1, 0, 0) to an anchor that is y beside the line of the arm.
Held rodOnArm(double y) {
  const Eigen::Vector3d along = Eigen::Vector3d(1, y, 0).normalized();
  return {"rod on an arm",
          armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0)).build(),
          sceneOf({0, -kGravity, 0}, closureOf(ClosureType::kDistance, frameAt("link_1", {1, 0, 0}),
                                               frameAt("link_0", {2, y, 0}))),
          1,
          along.y() / std::hypot(2, y),
          [along](const ClosedLoopResults& results) { return forceAlong(results, along); },
          kGravity / 2 / std::hypot(2, y)};
}

Held rodOnSlide(double y) {
  const Eigen::Vector3d along = Eigen::Vector3d(y, 1, 0).normalized();
  return {"rod on a slide",
          armOf(JointType::kPrismatic, Vector3l::UnitX(), Vector3l::Zero()).build(),
          sceneOf({kGravity, 0, 0}, closureOf(ClosureType::kDistance, frameAt("link_1", {0, 0, 0}),
                                              frameAt("link_0", {y, 1, 0}))),
          1,
          along.x(),
          [along](const ClosedLoopResults& results) { return forceAlong(results, along); },
          kGravity};
}

// A guide across the slide, turned by y out of the slide's direction.
Held guideOnSlide(double y) {
  const double slope = std::atan(y);
  return {
      "guide along a slide",
      armOf(JointType::kPrismatic, Vector3l::UnitX(), Vector3l::Zero()).build(),
      sceneOf({kGravity, 0, 0}, closureOf(ClosureType::kCylindrical,
                                          {"link_0", {0, 0.3, 0}, {0, std::acos(0.0) + slope, 0}},
                                          {"link_1", {0, 0.3, 0}, {0, std::acos(0.0) + slope, 0}})),
      1,
      std::sin(slope),
      [slope](const ClosedLoopResults& results) {
        return forceAlong(results, {std::sin(slope), 0, std::cos(slope)});
      },
      kGravity};
}

// A plane in which the arm may move when its normal is the joint's axis.
Held planeOnArm(double y) {
  const double slope = std::atan(y);
  return {"plane of an arm",
          armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0)).build(),
          sceneOf({0, -kGravity, 0},
                  closureOf(ClosureType::kPlanar, {"link_0", {1, 0, 0}, {slope, 0, 0}},
                            {"link_1", {1, 0, 0}, {slope, 0, 0}})),
          1,
          std::sqrt(2) * std::sin(slope),  // of a force and a moment
          [slope](const ClosedLoopResults& results) {
            const Wrench& wrench = results.root("closure");
            return std::abs(wrench.torque.z() + wrench.force.y()) /
                   (std::sqrt(2) * std::sin(slope));
          },
          kGravity / 2};
}

// Two joints in one line, the second a mimic of the first, that together turn the arm by 3 q.
Held rodOnMimic(double y) {
  RobotBuilder builder = armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0));
  builder.removeInertia(1);
  builder.add(JointType::kContinuous, 1, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
  builder.mimicFirst(2, 0);
  builder.removeInertia(2);
  builder.link(2).mass = 1;
  builder.link(2).p_KoCm_K << 0.5L, 0, 0;
  const Eigen::Vector3d along = Eigen::Vector3d(1, y, 0).normalized();
  return {"rod on a mimic",
          builder.build(),
          sceneOf({0, -kGravity, 0}, closureOf(ClosureType::kDistance, frameAt("link_2", {1, 0, 0}),
                                               frameAt("link_0", {2, y, 0}))),
          3,
          3 * along.y() / std::hypot(2, y),
          [along](const ClosedLoopResults& results) { return forceAlong(results, along); },
          3 * kGravity / 2 / std::hypot(2, y)};
}

// A ball on the arm, far out on the joint's axis and y beside it.
Held ballOnAxis(double y) {
  return {
      "ball on an axis",
      armOf(JointType::kContinuous, Vector3l::UnitZ(), Vector3l(0.5L, 0, 0)).build(),
      sceneOf({0, -kGravity, 0}, closureOf(ClosureType::kSpherical, frameAt("link_0", {y, 0, 1}),
                                           frameAt("link_1", {y, 0, 1}))),
      1,
      y / std::hypot(1, y),
      [](const ClosedLoopResults& results) {
        return forceAlong(results, {0, 1, 0});
      },
      kGravity / 2 / std::hypot(1, y)};
}

const std::vector<std::function<Held(double)>> kMechanisms{rodOnArm,   rodOnSlide, guideOnSlide,
                                                           planeOnArm, rodOnMimic, ballOnAxis};

// Condition is size over lever, however few coordinates there are; what is determined is right to
// rounding times the condition; and once the rank is gone the mechanism is refused or flagged.
TEST(LoopRank, ConditionGrowsWithTheInverseOfTheLeverUntilTheRankIsGone) {
  for (const auto& make : kMechanisms) {
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
        EXPECT_NEAR(held.bearing(results), expected,
                    4 * (1 + 2) * kEps * condition * (expected + kGravity));
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
                "'joint_1'");
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

}  // namespace
}  // namespace virtual_work_dynamics
