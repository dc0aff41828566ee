#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "random_wrenches.h"
#include "reference_errors.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

#ifndef VWD_HAS_REAL113

TEST(KernelAccuracy, IsMeasuredIn113Bits) {
  GTEST_SKIP() << "this compiler has no number of 113 bits";
}

#else

// Accuracy that the package promises, relative to the largest result of the kind in the motion. In
// a single sample all efforts may be small differences of large moments, so that errors do not
// measure the recursion.
constexpr double kUpTo50Joints = 2e-15;
constexpr double kChain1000 = 2e-14;
// Accuracy of the recursion with 29 bits less: 1.1e-6.
constexpr double kFloat = kUpTo50Joints * (1 << 29);

struct Robot {
  std::string name;
  Mechanism mechanism;
  Scene scene;
  std::vector<Motion> motions;
  bool fixed_joints_too = false;

  Request request() const {
    return fixed_joints_too ? requestEveryJoint(mechanism) : requestAll(mechanism);
  }
};

// A number of samples that is not a multiple of a pack.
constexpr std::size_t kSamples = 19;

Robot chain(int joints, std::size_t samples = kSamples) {
  RobotBuilder builder = chainOf(joints);
  return {"chain of " + std::to_string(joints), builder.build(), Scene(), builder.motions(samples)};
}

Robot pendulum() {
  RobotBuilder random(3);
  random.add(0);
  random.add(1);
  Scene scene;
  scene.gravity = {9.81, 0, 0};
  return {"pendulum", readUrdf(pendulumUrdf()), scene, random.motions(kSamples)};
}

// Every kind of scene in turn.
Robot randomTree(unsigned seed) {
  const int links = 3 + static_cast<int>(seed * 7 % 48);
  RandomRobot random(seed, links);
  Robot robot{"random tree " + std::to_string(seed), readUrdf(random.urdf()), Scene(), {}};
  robot.scene.gravity = {1.2, -3.4, -9.1};
  robot.scene.static_motion = seed % 5 == 0;
  robot.fixed_joints_too = seed % 3 == 0;
  if (seed % 2 == 0) addAppliedWrenches(random, links, robot.scene);
  for (std::size_t n = 0; n < kSamples; ++n) {
    robot.motions.push_back(random.motion(robot.mechanism));
  }
  return robot;
}

// Single samples and blocks of every instruction set.
void expectDouble(const Robot& robot, double tolerance) {
  SCOPED_TRACE(robot.name);
  const Request request = robot.request();
  const ExpectedResults expected(robot.mechanism, robot.scene, request, robot.motions);
  for (const InstructionSet set : supportedInstructionSets()) {
    SCOPED_TRACE(toString(set));
    const InverseDynamics dynamics(robot.mechanism, robot.scene, request, set);
    const ResultErrors single = expected.errorsOf(dynamics, robot.motions);
    EXPECT_LE(single.largest(), tolerance) << "single samples: " << single;
    for (const BlockLayout layout : {BlockLayout::kStructureOfArrays, BlockLayout::kRowMajor}) {
      const ResultErrors block =
          expected.errorsOf(blockResults<double>(dynamics, robot.motions, layout, 1, set));
      EXPECT_LE(block.largest(), tolerance) << "block: " << block;
    }
  }
}

void expectFloat(Robot robot, double tolerance) {
  SCOPED_TRACE(robot.name);
  for (Motion& motion : robot.motions) {
    for (auto* vector : {&motion.q, &motion.qd, &motion.qdd}) {
      *vector = vector->cast<float>().cast<double>();
    }
  }
  const Request request = robot.request();
  const ExpectedResults expected(robot.mechanism, robot.scene, request, robot.motions);
  const InverseDynamics dynamics(robot.mechanism, robot.scene, request);
  for (const InstructionSet set : supportedInstructionSets()) {
    const ResultErrors errors = expected.errorsOf(
        blockResults<float>(dynamics, robot.motions, BlockLayout::kStructureOfArrays, 1, set));
    EXPECT_LE(errors.largest(), tolerance) << toString(set) << ": " << errors;
  }
}

TEST(KernelAccuracy, PendulumAndChains) {
  expectDouble(pendulum(), kUpTo50Joints);
  for (const int joints : {1, 7, 20, 50}) expectDouble(chain(joints), kUpTo50Joints);
}

TEST(KernelAccuracy, RandomTrees) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    expectDouble(randomTree(seed), kUpTo50Joints);
  }
}

// Moved by one coordinate: every combination of gears that is treated in its own way.
TEST(KernelAccuracy, MimicJoints) {
  for (const double multiplier : {1.0, -1.0, 2.5, 0.0}) {
    for (const double offset : {0.0, 0.7}) {
      for (const JointType type : {JointType::kRevolute, JointType::kPrismatic}) {
        RobotBuilder builder = chainOf(2);
        const Vector3l axis = builder.direction();
        const Matrix3l R_PK = builder.rotation();
        builder.add(type, 2, axis, R_PK, builder.vector(0.3));
        builder.mimicFirst(multiplier, offset);
        builder.add(3);
        expectDouble({"geared by " + std::to_string(multiplier) + " from " + std::to_string(offset),
                      builder.build(), Scene(), builder.motions(kSamples)},
                     kUpTo50Joints);
      }
    }
  }
}

// Thin rods that turn about themselves, a millimetre and a micrometre a metre: their moment of
// inertia is what remains where the others cancel.
TEST(KernelAccuracy, Needles) {
  for (const double slenderness : {6e-6, 6e-12}) {
    for (int along = 0; along < 3; ++along) {
      RobotBuilder builder(4);
      const Matrix3l R_PK = builder.rotation();
      const int rod =
          builder.add(JointType::kContinuous, 0, Vector3l::Unit(along), R_PK, Vector3l::Zero());
      Link& link = builder.link(rod);
      link.p_KoCm_K = 0.5 * Vector3l(Vector3l::Unit(along));
      link.inertia_Cm_K = (Vector3l::Ones() / 12).asDiagonal();
      link.inertia_Cm_K(along, along) *= slenderness;
      expectDouble({"needle", builder.build(), Scene(), builder.motions(kSamples)}, kUpTo50Joints);
    }
  }
}

TEST(KernelAccuracy, ChainOfAThousand) {
  expectDouble(chain(1000, 9), kChain1000);
}

// Angles at which a reduction can go wrong; `range`: where another takes over.
std::vector<double> hardAngles(double range) {
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<double> angles = {0,
                                std::numeric_limits<double>::denorm_min(),
                                1e-310,
                                1e-160,
                                1e-17,
                                3e-9,
                                range,
                                std::nextafter(range, 0),
                                std::nextafter(range, inf),
                                range - 0.7,
                                range + 0.7,
                                1e9,
                                0.9e9 + 0.1};
  for (const double k : {1, 2, 3, 4, 5, 6, 7, 101, 354, 1022, 31415, 636618, 636619, 100000001}) {
    const double multiple = k * (M_PI / 2);
    angles.insert(angles.end(), {multiple, std::nextafter(multiple, inf),
                                 std::nextafter(multiple, 0), multiple / 2});
  }
  const std::size_t positive = angles.size();
  for (std::size_t i = 0; i < positive; ++i) angles.push_back(-angles[i]);
  return angles;
}

// One joint in `step` of a sample gets a hard angle, so that packs of samples and of joints mix
// them with common ones.
Robot withHardAngles(int joints, double range, int step) {
  const std::vector<double> angles = hardAngles(range);
  Robot robot = chain(joints, 2 * angles.size());
  std::size_t next = 0;
  for (std::size_t n = 0; n < robot.motions.size(); ++n) {
    for (int i = static_cast<int>(n) % step; i < joints; i += step) {
      robot.motions[n].q[i] = angles[next++ % angles.size()];
    }
  }
  return robot;
}

constexpr double kDoubleRange = 1e6, kFloatRange = 3000;

TEST(KernelAccuracy, HardAngles) {
  for (const int step : {1, 2, 5})
    expectDouble(withHardAngles(7, kDoubleRange, step), kUpTo50Joints);
  expectDouble(withHardAngles(33, kDoubleRange, 11), kUpTo50Joints);
}

TEST(KernelAccuracy, Float) {
  expectFloat(pendulum(), kFloat);
  for (const int joints : {1, 7, 20, 50}) expectFloat(chain(joints), kFloat);
  for (unsigned seed = 1; seed <= 40; ++seed) {
    expectFloat(randomTree(seed), kFloat);
  }
}

TEST(KernelAccuracy, FloatWithHardAngles) {
  for (const int step : {1, 2, 5}) expectFloat(withHardAngles(7, kFloatRange, step), kFloat);
  expectFloat(withHardAngles(33, kFloatRange, 11), kFloat);
}

#endif

}  // namespace
}  // namespace virtual_work_dynamics
