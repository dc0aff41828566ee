#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "four_bar.h"
#include "robot_builder.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kOrders = 20;  // of visits

/// Which results of one sample exist.
struct Existing {
  explicit Existing(const Results& results)
      : effort(results.loops.effort_exists),
        child_axes(results.loops.child_axes_exist),
        root_axes(results.loops.root_axes_exist) {}

  std::vector<bool> effort;
  std::vector<Determined> child_axes, root_axes;
};

void expectSame(const Existing& found, const Existing& expected) {
  EXPECT_EQ(found.effort, expected.effort);
  EXPECT_EQ(found.child_axes, expected.child_axes);
  EXPECT_EQ(found.root_axes, expected.root_axes);
}

/// A mechanism with a singular position and regular ones, each a motion that closes its loops.
struct Singular {
  Mechanism mechanism;
  Scene scene;
  std::vector<std::string> names;  // of reactions
  Motion position;
  std::vector<Motion> regular;
  bool bears = false;  // its load in the singular position; else passive joints lack efforts, too

  Dynamics dynamics() const {
    Request request;
    request.child_axes = request.root_axes = names;
    return Dynamics(mechanism, scene, request);
  }
};

/// The slider drives; the arm is in no loop.
Singular sliderCrankAtDeadCentre(double rod_mass) {
  const SliderCrank slider_crank(rod_mass, true);
  Scene scene = slider_crank.scene("joint_3");
  scene.actuated->push_back("joint_4");
  scene.gravity << 0, -9.81, 0;
  Singular singular{slider_crank.mechanism(),
                    scene,
                    {kGround, "joint_1", "joint_2", "joint_3", "joint_4", "pin"},
                    SliderCrank::motion(0, 3, 0, 4),
                    {}};
  singular.bears = rod_mass == 0;
  for (const double angle : {0.7, -0.4, 1.2, 2.0, -1.9, 0.05}) {
    singular.regular.push_back(SliderCrank::motion(angle, 3, 1, 4));
  }
  return singular;
}

/// A parallelogram whose links lie on each other along x at zero, its plane that of x and y.
Singular parallelogramAtItsChangePoint() {
  const double crank = 0.3, coupler = 0.8;
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), R, Vector3l::Zero());
  builder.add(JointType::kContinuous, 1, Vector3l::UnitZ(), R, Vector3l(crank, 0, 0));
  builder.add(JointType::kContinuous, 2, Vector3l::UnitZ(), R, Vector3l(coupler, 0, 0));
  Scene scene;
  Closure pivot;
  pivot.name = "pivot";
  pivot.type = ClosureType::kRevolute;
  pivot.parent = {"link_0", {coupler, 0, 0}, {0, 0, 0}};
  pivot.child = {"link_3", {-crank, 0, 0}, {0, 0, 0}};
  scene.closures = {pivot};
  scene.actuated = std::vector<std::string>{"joint_1"};
  scene.assembly = {{"joint_1", 1.0}, {"joint_2", -1.0}, {"joint_3", 1.0}};
  const auto motionAt = [](double angle) {
    Motion motion(3);
    motion.q << angle, -angle, angle;
    motion.qd << 2, -2, 2;
    return motion;
  };
  Singular singular{
      builder.build(), scene, {kGround, "joint_1", "joint_2", "joint_3", "pivot"}, motionAt(0), {}};
  for (const double angle : {1.0, -0.3, 0.6, 2.0, -2.5, 0.1}) {
    singular.regular.push_back(motionAt(angle));
  }
  return singular;
}

/// Its plane lies obliquely in the root link.
Singular obliqueParallelogram() {
  FourBar four_bar;
  four_bar.lengths = {0.3L, 0.8L, 0.3L, 0.8L};
  const FourBar::Cut cut = four_bar.cut('D');
  const auto motionAt = [&](long double angle) {
    return cut.motion({{{angle, 2, 0}, {0, 0, 0}, {angle, 2, 0}}});
  };
  Singular singular{cut.mechanism, cut.scene, {kGround, "A", "B", "C", "D"}, motionAt(0), {}};
  singular.scene.assembly = {{"A", 1.0}, {"B", -1.0}, {"C", 1.0}};
  for (const long double angle : {1.0L, -0.3L, 0.6L, 2.0L, -2.5L, 0.1L}) {
    singular.regular.push_back(motionAt(angle));
  }
  return singular;
}

Singular assembledAtItsSingularPosition(Singular singular) {
  singular.scene.assembly.clear();
  for (std::size_t i = 0; i < singular.mechanism.coordinates().size(); ++i) {
    singular.scene.assembly.push_back({singular.mechanism.coordinateNames()[i],
                                       singular.position.q[static_cast<Eigen::Index>(i)]});
  }
  return singular;
}

std::vector<Singular> all() {
  std::vector<Singular> all{sliderCrankAtDeadCentre(0), sliderCrankAtDeadCentre(1.5),
                            parallelogramAtItsChangePoint(), obliqueParallelogram()};
  for (std::size_t i = 0; i < 4; ++i) all.push_back(assembledAtItsSingularPosition(all[i]));
  return all;
}

Existing existingAt(const Dynamics& dynamics, const Motion& motion) {
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  EXPECT_TRUE(workspace.results().finite());
  return Existing(workspace.results());
}

TEST(Existence, DoesNotDependOnThePositionsMetBefore) {
  std::mt19937 generator(5);
  for (Singular& singular : all()) {
    SCOPED_TRACE(singular.mechanism.name());
    const Dynamics dynamics = singular.dynamics();
    const Existing fresh = existingAt(dynamics, singular.position);
    EXPECT_EQ(std::count(fresh.effort.begin(), fresh.effort.end(), false), singular.bears ? 1 : 3);
    for (int i = 0; i < kOrders; ++i) {
      std::shuffle(singular.regular.begin(), singular.regular.end(), generator);
      Dynamics::Workspace workspace = dynamics.makeWorkspace();
      for (const Motion& regular : singular.regular) {
        Motion completed = regular;
        dynamics.complete(completed, workspace);
        dynamics.compute(regular, workspace);
        ASSERT_FALSE(workspace.results().singular());
      }
      dynamics.compute(singular.position, workspace);
      ASSERT_TRUE(workspace.results().singular());
      expectSame(Existing(workspace.results()), fresh);
      expectSame(existingAt(dynamics, singular.position), fresh);
    }
  }
}

// Even where that position is singular.
TEST(Existence, DoesNotDependOnWhereTheLoopsAreAssembled) {
  for (const Singular& singular : {sliderCrankAtDeadCentre(0), sliderCrankAtDeadCentre(1.5),
                                   parallelogramAtItsChangePoint(), obliqueParallelogram()}) {
    SCOPED_TRACE(singular.mechanism.name());
    const Existing expected = existingAt(singular.dynamics(), singular.position);
    const Singular assembled = assembledAtItsSingularPosition(singular);
    EXPECT_EQ(assembled.dynamics().assembly(), singular.position.q);
    expectSame(existingAt(assembled.dynamics(), singular.position), expected);
    Singular elsewhere = singular;
    elsewhere.scene.assembly.clear();
    const Motion& motion = singular.regular.back();
    for (std::size_t i = 0; i < singular.mechanism.coordinates().size(); ++i) {
      elsewhere.scene.assembly.push_back(
          {singular.mechanism.coordinateNames()[i], motion.q[static_cast<Eigen::Index>(i)]});
    }
    expectSame(existingAt(elsewhere.dynamics(), singular.position), expected);
  }
}

TEST(Existence, EverythingExistsInRegularPositions) {
  for (const Singular& singular : all()) {
    SCOPED_TRACE(singular.mechanism.name());
    const Dynamics dynamics = singular.dynamics();
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    for (const Motion& regular : singular.regular) {
      for (const Motion* motion : {&singular.position, &regular}) {
        dynamics.compute(*motion, workspace);
      }
      const Existing found(workspace.results());
      EXPECT_EQ(std::count(found.effort.begin(), found.effort.end(), false), 0);
      const std::vector<Determined> everything(singular.names.size(), kAllComponents);
      EXPECT_EQ(found.child_axes, everything);
      EXPECT_EQ(found.root_axes, everything);
      const LoopResults& loops = workspace.results().loops;
      EXPECT_NE(loops.child_axes_determined, everything);  // but not all of it is determined
      Dynamics::Workspace fresh = dynamics.makeWorkspace();
      dynamics.compute(regular, fresh);
      EXPECT_EQ(loops.child_axes_determined, fresh.results().loops.child_axes_determined);
      EXPECT_EQ(loops.root_axes_determined, fresh.results().loops.root_axes_determined);
    }
  }
}

// What a singular position opens is hidden in components that are open anyway where the plane lies
// obliquely: a reaction that is incomplete in some axes must not seem complete in others.
TEST(Existence, OfAWholeReactionDoesNotDependOnTheAxes) {
  int incomplete = 0;
  for (const Singular& singular : all()) {
    SCOPED_TRACE(singular.mechanism.name());
    const Existing found = existingAt(singular.dynamics(), singular.position);
    for (std::size_t i = 0; i < singular.names.size(); ++i) {
      EXPECT_EQ(found.child_axes[i] == kAllComponents, found.root_axes[i] == kAllComponents)
          << singular.names[i];
      incomplete += found.root_axes[i] != kAllComponents;
    }
  }
  EXPECT_GE(incomplete, 20);
}

// The plane is that of x and y, and in these positions all axes are parallel to the root's.
struct Expected {
  std::vector<bool> effort;
  std::vector<Determined> reactions;
};

void expectExisting(const Singular& singular, const Expected& expected) {
  for (const Singular& assembled : {singular, assembledAtItsSingularPosition(singular)}) {
    const Existing found = existingAt(assembled.dynamics(), assembled.position);
    EXPECT_EQ(found.effort, expected.effort);
    for (std::size_t i = 0; i < singular.names.size(); ++i) {
      EXPECT_EQ(found.child_axes[i], expected.reactions[i]) << singular.names[i];
      EXPECT_EQ(found.root_axes[i], expected.reactions[i]) << singular.names[i];
    }
  }
}

// fx fy fz tx ty tz. Out of the plane: fz, tx and ty, which are redundant in every position.
constexpr Determined kNotAlongX{{false, true, true, true, true, true}};

// The rod can push with any force, and so can the slider's motor: ground bears both.
TEST(Existence, AtDeadCentreTheRodPushesWithAnyForce) {
  expectExisting(sliderCrankAtDeadCentre(0), {{true, true, false, true},
                                              {kAllComponents, kNotAlongX, kNotAlongX, kNotAlongX,
                                               kAllComponents, kNotAlongX}});
}

// At rest, with the weight normal to the plane: the links can be stretched by any force.
TEST(Existence, AtTheChangePointTheLinksAreStretchedByAnyForce) {
  Singular singular = parallelogramAtItsChangePoint();
  singular.position.qd.setZero();
  expectExisting(singular, {{true, true, true},
                            {kAllComponents, kNotAlongX, kNotAlongX, kNotAlongX, kNotAlongX}});
}

// In motion, the links want torques that nothing gives there: nothing in the plane has a value but
// what ground bears in all, and the moment of the pivot, which turns freely; nor has the effort
// zero of passive joints, which is not what the links want.
TEST(Existence, ALoadThatTheChangePointDoesNotBearLeavesMoreOpen) {
  constexpr Determined kOutOfPlane{{false, false, true, true, true, false}};
  constexpr Determined kPivot{{false, false, true, true, true, true}};
  expectExisting(
      parallelogramAtItsChangePoint(),
      {{false, false, false}, {kAllComponents, kOutOfPlane, kOutOfPlane, kOutOfPlane, kPivot}});
}

/// An arm along x that a rod along it does not hold against its weight.
Singular armInLineWithItsRod() {
  RobotBuilder builder(1);
  builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
  builder.link(1).p_KoCm_K << 0.3L, 0.01L, 0.02L;
  Scene scene;
  scene.gravity << 0, -9.81, 0;
  Closure rod;
  rod.name = "rod";
  rod.type = ClosureType::kDistance;
  rod.parent = {"link_0", {1.1, 0, 0}, {0, 0, 0}};
  rod.child = {"link_1", {0.5, 0, 0}, {0, 0, 0}};
  scene.closures = {rod};
  scene.actuated.emplace();
  return {builder.build(), scene, {kGround, "joint_1", "rod"}, Motion(1), {}};
}

// One coordinate that moves freely is like many: what nothing balances has no value, neither in the
// effort of the passive joint nor about its axis, nor have forces across the rod, which beside the
// position bear a finite part of the load however close to it.
TEST(Existence, ALoadThatARodInLineDoesNotBearHasNoValue) {
  expectExisting(armInLineWithItsRod(), {{false},
                                         {kAllComponents,
                                          {{false, false, true, true, true, false}},
                                          {{false, false, true, true, true, true}}}});
  Singular light = armInLineWithItsRod();
  light.scene.gravity.setZero();
  expectExisting(light, {{true},
                         {kAllComponents,
                          {{false, true, true, true, true, true}},
                          {{false, true, true, true, true, true}}}});
}

// Values chosen by the policy exist in singular positions, too, and equal those beside them: the
// pivot bears its share of the weight, which is normal to the plane.
TEST(Existence, RedundantComponentsKeepWhatThePolicyChooses) {
  constexpr double kBeside = 1e-6;     // rad
  constexpr double kTolerance = 1e-4;  // of the weight: what so small an angle may change
  constexpr double kRounding = 1e-12;  // of the weight
  Singular singular = parallelogramAtItsChangePoint();
  singular.scene.redundancy.policy = RedundancyPolicy::kStiffness;
  singular.position.qd.setZero();
  Motion beside = singular.position;
  beside.q << kBeside, -kBeside, kBeside;
  double weight = 0;
  for (const Link& link : singular.mechanism.links()) {
    if (link.parent_joint >= 0) weight += 9.81 * static_cast<double>(link.mass);
  }
  const Dynamics dynamics = singular.dynamics();
  Dynamics::Workspace regular = dynamics.makeWorkspace(), workspace = dynamics.makeWorkspace();
  dynamics.compute(beside, regular);
  dynamics.compute(singular.position, workspace);
  ASSERT_FALSE(regular.results().singular());
  ASSERT_TRUE(workspace.results().singular());
  const std::vector<Wrench>& near = regular.results().root_axes;
  const std::vector<Wrench>& wrenches = workspace.results().root_axes;
  EXPECT_GT(std::abs(wrenches[4].force.z()), 0.01 * weight);
  EXPECT_NEAR(wrenches[1].force.z() + wrenches[4].force.z(), weight, kRounding * weight);
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    EXPECT_NEAR(wrenches[i].force.z(), near[i].force.z(), kTolerance * weight);
    for (const int axis : {0, 1}) {
      EXPECT_NEAR(wrenches[i].torque[axis], near[i].torque[axis], kTolerance * weight);
    }
    const Determined exist = workspace.results().rootAxesExist(i);
    for (const std::size_t out_of_plane : {2, 3, 4}) EXPECT_TRUE(exist[out_of_plane]);
    if (i > 0) {
      EXPECT_FALSE(workspace.results().loops.root_axes_determined[i][2]);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
