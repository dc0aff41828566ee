#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "closed_loops.h"
#include "four_bar.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kTolerance = 1e-9;  // of positions that two ways lead to
const Matrix3l kUpright = Matrix3l::Identity();

LinkFrame frameAt(const std::string& link, const Eigen::Vector3d& xyz) {
  LinkFrame frame;
  frame.link = link;
  frame.xyz = xyz;
  return frame;
}

Closure closureOf(const std::string& name, ClosureType type, const LinkFrame& parent,
                  const LinkFrame& child) {
  Closure closure;
  closure.name = name;
  closure.type = type;
  closure.parent = parent;
  closure.child = child;
  return closure;
}

Scene startingAt(Scene scene, const Mechanism& mechanism, const Eigen::VectorXd& q) {
  scene.assembly.clear();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    scene.assembly.push_back({mechanism.coordinateNames()[static_cast<std::size_t>(i)], q[i]});
  }
  return scene;
}

Scene exchanged(Scene scene) {
  for (Closure& closure : scene.closures) std::swap(closure.parent, closure.child);
  return scene;
}

/// Two thighs that hang down, half a distance left and right, with shins whose feet are pinned.
struct Leg {
  static constexpr double kHip = 0.05, kThigh = 0.12, kShin = 0.25;

  Leg() : mechanism(make()) {
    scene.closures = {closureOf("foot", ClosureType::kRevolute, frameAt("link_2", {0, -kShin, 0}),
                                frameAt("link_4", {0, -kShin, 0}))};
    scene.actuated = std::vector<std::string>{"joint_1", "joint_3"};
  }
  static Mechanism make() {
    RobotBuilder builder(1);
    const Vector3l z = Vector3l::UnitZ(), down(0, -kThigh, 0);
    builder.add(JointType::kContinuous, 0, z, kUpright, Vector3l(-kHip, 0, 0));
    builder.add(JointType::kContinuous, 1, z, kUpright, down);
    builder.add(JointType::kContinuous, 0, z, kUpright, Vector3l(kHip, 0, 0));
    builder.add(JointType::kContinuous, 3, z, kUpright, down);
    return builder.build();
  }
  static double closedKnee() { return std::asin(kHip / kShin); }

  Mechanism mechanism;
  Scene scene;
};

// The other branch, with the feet above the thighs, is half a turn away.
TEST(Assembly, OfALegIsTheNearBranchFromEverySensibleStart) {
  const Leg leg;
  int near = 0;
  for (const Scene& scene : {leg.scene, exchanged(leg.scene)}) {
    for (int left = 0; left <= 10; ++left) {
      for (int right = 0; right <= 10; ++right) {
        const Eigen::VectorXd start = Eigen::Vector4d(0, 0.15 * left, 0, -0.15 * right);
        const ClosedLoops loops(leg.mechanism, startingAt(scene, leg.mechanism, start));
        const Eigen::VectorXd closed = Eigen::Vector4d(0, Leg::closedKnee(), 0, -Leg::closedKnee());
        EXPECT_LE((loops.assembly() - closed).norm(), kTolerance) << start.transpose();
        ++near;
      }
    }
  }
  EXPECT_EQ(near, 2 * 121);
}

/// A bar on parallel cranks of one length, driven at the first: one redundant constraint in the
/// plane for each crank after the second.
struct Cranks {
  static constexpr double kCrank = 0.3;

  explicit Cranks(int cranks) : mechanism(make(cranks)) {
    for (int i = 1; i < cranks; ++i) {
      scene.closures.push_back(closureOf("pin_" + std::to_string(i), ClosureType::kRevolute,
                                         frameAt("link_" + std::to_string(i + 2), {kCrank, 0, 0}),
                                         frameAt("link_2", {double(i), 0, 0})));
    }
    scene.actuated = std::vector<std::string>{"joint_1"};
  }
  static Mechanism make(int cranks) {
    RobotBuilder builder(1);
    const Vector3l z = Vector3l::UnitZ();
    builder.add(JointType::kContinuous, 0, z, kUpright, Vector3l::Zero());
    builder.add(JointType::kContinuous, 1, z, kUpright, Vector3l(kCrank, 0, 0));
    for (int i = 1; i < cranks; ++i) {
      builder.add(JointType::kContinuous, 0, z, kUpright, Vector3l(i, 0, 0));
    }
    return builder.build();
  }
  Eigen::VectorXd closed(double angle) const {
    Eigen::VectorXd q =
        Eigen::VectorXd::Constant(static_cast<Eigen::Index>(mechanism.coordinates().size()), angle);
    q[1] = -angle;
    return q;
  }

  Mechanism mechanism;
  Scene scene;
};

// Where the loops are open, the redundant conditions look independent, and so as if the motor had
// to move.
TEST(Assembly, LeavesTheMotorOfRedundantLoopsWhereItStarts) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  for (const int cranks : {2, 3, 5}) {
    const Cranks bar(cranks);
    for (int i = 0; i < 50; ++i) {
      const double angle = 1.2 + uniform(generator);
      const Eigen::VectorXd closed = bar.closed(angle);
      Eigen::VectorXd start = closed;
      for (Eigen::Index j = 1; j < start.size(); ++j) start[j] += uniform(generator);
      for (const Scene& scene : {bar.scene, exchanged(bar.scene)}) {
        const ClosedLoops loops(bar.mechanism, startingAt(scene, bar.mechanism, start));
        EXPECT_EQ(loops.assembly()[0], angle);
        EXPECT_LE((loops.assembly() - closed).norm(), kTolerance) << start.transpose();
      }
    }
  }
}

// Both ends of a four-bar are motors: one of them has to give way, and as little as it can.
TEST(Assembly, MovesMotorsThatAreTooMany) {
  FourBar::Cut cut = FourBar().cut('D');
  const Eigen::VectorXd closed = ClosedLoops(cut.mechanism, cut.scene).assembly();
  cut.scene.actuated = cut.mechanism.coordinateNames();
  Eigen::VectorXd start = closed;
  start[0] += 0.2;
  const ClosedLoops loops(cut.mechanism, startingAt(cut.scene, cut.mechanism, start));
  EXPECT_LE((loops.assembly() - start).norm(), (closed - start).norm() + kTolerance);
  EXPECT_GT((loops.assembly() - start).norm(), 1e-3);
}

/// A loop in space of the type, of joints in general position, closed at `closed`.
struct SpatialLoop {
  SpatialLoop(ClosureType type, int conditions, unsigned seed) : builder(seed) {
    const int joints = conditions + 1;
    closed.resize(joints);
    for (int i = 0; i < joints; ++i) {
      const Vector3l axis = builder.direction(), place = builder.vector(0.5);
      const Matrix3l R = builder.rotation();
      builder.add(JointType::kContinuous, i, axis, R, place);
      closed[i] = builder.uniform(-3, 3);
    }
    mechanism = std::make_unique<Mechanism>(builder.build());
    Eigen::Vector3d o = Eigen::Vector3d::Zero();
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    for (int i = 0; i < joints; ++i) {
      const Joint& joint = mechanism->joint(i);
      o += R * joint.p_PoKo_P.cast<double>();
      R = R * joint.R_PK.cast<double>() *
          Eigen::AngleAxisd(closed[i], joint.axis_K.cast<double>()).toRotationMatrix();
    }
    const LinkFrame tip =
        frameAt(mechanism->links().back().name, builder.vector(0.5).cast<double>());
    LinkFrame base = frameAt("link_0", o + R * tip.xyz);
    base.rpy << std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)), std::atan2(R(1, 0), R(0, 0));
    if (type == ClosureType::kDistance) base.xyz += Eigen::Vector3d(0.3, -0.2, 0.4);
    scene.closures = {closureOf("closure", type, base, tip)};
    if (type == ClosureType::kDistance) {
      scene.closures[0].length = (base.xyz - (o + R * tip.xyz)).norm();
    }
    scene.actuated = std::vector<std::string>{mechanism->coordinateNames()[0]};
  }

  RobotBuilder builder;
  std::unique_ptr<Mechanism> mechanism;
  Scene scene;
  Eigen::VectorXd closed;
};

// From a start that is off in all passive joints, the solution that was left or a nearer one; the
// motor stays; and it is the same one whichever way round the closure is written.
TEST(Assembly, FindsTheNearSolutionOfEveryTypeOfClosure) {
  constexpr int kLoops = 12;
  const std::vector<std::pair<ClosureType, int>> types{
      {ClosureType::kFixed, 6},       {ClosureType::kRevolute, 5},  {ClosureType::kPrismatic, 5},
      {ClosureType::kCylindrical, 4}, {ClosureType::kUniversal, 4}, {ClosureType::kSpherical, 3},
      {ClosureType::kPlanar, 3},      {ClosureType::kDistance, 1}};
  int starts = 0, near = 0;
  for (const auto& type : types) {
    for (unsigned seed = 1; seed <= kLoops; ++seed) {
      SpatialLoop loop(type.first, type.second, seed);
      for (const double off : {0.1, 0.3, 0.5, 0.8}) {
        SCOPED_TRACE(std::to_string(type.second) + " conditions, loop " + std::to_string(seed));
        Eigen::VectorXd start = loop.closed;
        for (Eigen::Index i = 1; i < start.size(); ++i) start[i] += loop.builder.uniform(-off, off);
        const Scene scene = startingAt(loop.scene, *loop.mechanism, start);
        const ClosedLoops loops(*loop.mechanism, scene);
        // Its frames are of different use: z of the parent's and x of the child's.
        const bool universal = type.first == ClosureType::kUniversal;
        const ClosedLoops other(*loop.mechanism, universal ? scene : exchanged(scene));
        EXPECT_EQ(loops.assembly()[0], start[0]);
        EXPECT_LE((loops.assembly() - other.assembly()).norm(), 1e-6);
        ++starts;
        near += (loops.assembly() - start).norm() <= (loop.closed - start).norm() + kTolerance;
      }
    }
  }
  EXPECT_EQ(starts, 4 * kLoops * 8);
  EXPECT_GE(near, 0.99 * starts);
}

// A warning names what was assembled far from its start.
TEST(Assembly, SaysWhatEndsFarFromItsStart) {
  const Leg leg;
  const Eigen::VectorXd start = Eigen::Vector4d(0, 1.9, 0, -0.1);
  const ClosedLoopDynamics far(leg.mechanism, startingAt(leg.scene, leg.mechanism, start), {});
  const std::vector<std::string> doubts = far.assemblyDoubts();
  ASSERT_EQ(doubts.size(), 1);
  EXPECT_EQ(doubts[0].find("assembly: 'joint_2' ends 1.699 rad from its start, at 0.2014 rad"), 0u)
      << doubts[0];
  const ClosedLoopDynamics near(leg.mechanism, leg.scene, {});
  EXPECT_TRUE(near.assemblyDoubts().empty());
}

}  // namespace
}  // namespace virtual_work_dynamics
