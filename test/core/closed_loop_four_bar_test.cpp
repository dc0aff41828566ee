#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "four_bar.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest force or moment: a handful of roundings in a well-conditioned system.
constexpr double kPlanarTolerance = 1e-12;

// In-plane force on the child of a joint in the child's axes, from the free bodies.
FourBar::Vector2 expected(const FourBar::Forces& forces, const FourBar::Turnings& turnings,
                          const FourBar::Cut::Hanging& joint) {
  const bool other = (joint.pivot == 'B' && joint.body == FourBar::kCrank) ||
                     (joint.pivot == 'C' && joint.body == FourBar::kCoupler);
  const FourBar::Vector2 force = (other ? -1 : 1) * forces.on_body.at(joint.pivot);
  const auto angle = turnings[static_cast<std::size_t>(joint.body)].angle;
  return {force.dot(FourBar::along(angle)), force.dot(FourBar::normal(angle))};
}

// Determined results of a linkage equal those of its free bodies.
void expectFreeBodies(const FourBar& four_bar, const FourBar::Cut& cut,
                      const FourBar::Turnings& turnings, double unit = 1) {
  const ClosedLoopResults results(cut.mechanism, cut.scene, cut.motion(turnings));
  const FourBar::Forces forces = four_bar.freeBodies(turnings);
  double largest = std::abs(static_cast<double>(forces.torque)) / unit;
  for (const auto& force : forces.on_body) {
    largest = std::max(largest, static_cast<double>(force.second.norm()));
  }
  auto joints = cut.joints;
  joints.push_back(cut.closure);
  for (const auto& joint : joints) {
    const Wrench& wrench = results.child(std::string(1, joint.pivot));
    const auto force = expected(forces, turnings, joint);
    EXPECT_NEAR(wrench.force.x(), static_cast<double>(force.x()), kPlanarTolerance * largest);
    EXPECT_NEAR(wrench.force.y(), static_cast<double>(force.y()), kPlanarTolerance * largest);
    const double torque = joint.pivot == 'A' ? static_cast<double>(forces.torque) : 0;
    EXPECT_NEAR(wrench.torque.z(), torque, kPlanarTolerance * largest * unit);
  }
  EXPECT_NEAR(results.dynamics.effort().sum(), static_cast<double>(forces.torque),
              kPlanarTolerance * largest * unit);
  EXPECT_TRUE(results.dynamics.finite());
}

class EachCut : public ::testing::TestWithParam<char> {};

TEST_P(EachCut, InPlaneForcesAndTorqueEqualThoseOfTheFreeBodies) {
  const FourBar four_bar;
  for (const double angle : {0.3, 1.1, 2.5, 4.0, 5.7}) {
    expectFreeBodies(four_bar, four_bar.cut(GetParam()), four_bar.turnings(angle, 3.1, -4.2));
  }
}

TEST_P(EachCut, ThreeConstraintsAreRedundantAndFlagTheOutOfPlaneReactions) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  const ClosedLoopResults results(cut.mechanism, cut.scene,
                                  cut.motion(four_bar.turnings(1.1, 3.1, -4.2)));
  const Determinacy& determinacy = results.dynamics.determinacy();
  EXPECT_EQ(determinacy.redundant_constraints, 3);
  EXPECT_EQ(determinacy.redundancy, 3);
  EXPECT_EQ(determinacy.rank, 3);
  EXPECT_EQ(determinacy.free_motions, 0);
  EXPECT_GT(determinacy.gap, 1e10);
  EXPECT_LT(determinacy.condition, 100);
  for (const char* pivot : {"A", "B", "C", "D"}) {
    EXPECT_EQ(results.childDetermined(pivot), (Determined{true, true, false, false, false, true}));
  }
  for (const bool determined : results.dynamics.effortDetermined()) EXPECT_TRUE(determined);
}

TEST_P(EachCut, NoPolicyChangesWhatIsDetermined) {
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut(GetParam());
  const auto turnings = four_bar.turnings(2.5, 3.1, -4.2);
  Redundancy& redundancy = cut.scene.redundancy;
  redundancy.policy = RedundancyPolicy::kZeroAt;
  redundancy.zero_at = {cut.scene.closures[0].name};
  expectFreeBodies(four_bar, cut, turnings);
  redundancy.policy = RedundancyPolicy::kStiffness;
  redundancy.stiffness = {{"B", 30}, {"C", 0.2}};
  expectFreeBodies(four_bar, cut, turnings);
  redundancy.length = 1e-3;
  expectFreeBodies(four_bar, cut, turnings);
}

// Stiffnesses belong to the four joints, so that the cut matters to no component at all.
TEST_P(EachCut, ReactionsByStiffnessDoNotDependOnTheCut) {
  const FourBar four_bar;
  const auto turnings = four_bar.turnings(2.5, 3.1, -4.2);
  const auto reactions = [&](char pivot) {
    FourBar::Cut cut = four_bar.cut(pivot);
    cut.scene.redundancy.policy = RedundancyPolicy::kStiffness;
    cut.scene.redundancy.stiffness = {{"B", 3}, {"C", 0.2}, {"D", 7}};
    cut.scene.redundancy.length = 0.3;
    const ClosedLoopResults results(cut.mechanism, cut.scene, cut.motion(turnings));
    return results.root("D");  // ground on the rocker in every cut
  };
  const Wrench expected_wrench = reactions('B'), wrench = reactions(GetParam());
  const double largest = expected_wrench.force.norm();
  EXPECT_LE((wrench.force - expected_wrench.force).norm(), kPlanarTolerance * largest);
  EXPECT_LE((wrench.torque - expected_wrench.torque).norm(), kPlanarTolerance * largest);
}

TEST_P(EachCut, LengthsInMillimetresChangeNothingButTheUnit) {
  const FourBar four_bar(1000);
  expectFreeBodies(four_bar, four_bar.cut(GetParam()), four_bar.turnings(1.1, 3.1, -4.2), 1000);
}

// Nor does the choice among what is not determined depend on it.
TEST_P(EachCut, LeastNormsDoNotDependOnTheUnitOfLength) {
  const FourBar metres, millimetres(1000);
  const auto turnings = metres.turnings(1.1, 3.1, -4.2);
  const auto resultsOf = [&](const FourBar& four_bar) {
    const FourBar::Cut cut = four_bar.cut(GetParam());
    return ClosedLoopResults(cut.mechanism, cut.scene, cut.motion(turnings));
  };
  const ClosedLoopResults in_m = resultsOf(metres), in_mm = resultsOf(millimetres);
  double open = 0;
  for (const char* pivot : {"A", "B", "C", "D"}) {
    const Wrench &m = in_m.child(pivot), &mm = in_mm.child(pivot);
    open += std::abs(m.torque.x()) + std::abs(m.force.z());
    EXPECT_LE((mm.force / 1e3 - m.force).norm(), kPlanarTolerance * m.force.norm());
    EXPECT_LE((mm.torque / 1e6 - m.torque).norm(), kPlanarTolerance * m.force.norm());
  }
  EXPECT_GT(open, 1);
}

// One equation of power between two actuated joints: the least weighted squares share the torque as
// their rates over their weights.
TEST_P(EachCut, TwoMotorsShareByTheirWeights) {
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut(GetParam());
  const auto turnings = four_bar.turnings(1.1, 3.1, -4.2);
  const FourBar::Forces alone = four_bar.freeBodies(turnings);
  cut.scene.actuated = std::vector<std::string>{"A", "D"};
  cut.scene.redundancy.effort_weights = {{"A", 2}, {"D", 5}};
  const ClosedLoopResults results(cut.mechanism, cut.scene, cut.motion(turnings));
  const auto rate_A = turnings[FourBar::kCrank].rate, rate_D = turnings[FourBar::kRocker].rate;
  const auto power = alone.torque * rate_A;
  const auto scale = power / (rate_A * rate_A / 2 + rate_D * rate_D / 5);
  const double largest = std::abs(static_cast<double>(alone.torque));
  EXPECT_NEAR(results.child("A").torque.z(), static_cast<double>(scale * rate_A / 2),
              kPlanarTolerance * largest);
  EXPECT_NEAR(results.child("D").torque.z(), static_cast<double>(scale * rate_D / 5),
              kPlanarTolerance * largest);
  EXPECT_EQ(results.dynamics.determinacy().redundancy, 4);
  EXPECT_EQ(results.dynamics.determinacy().redundant_constraints, 3);
  EXPECT_FALSE(results.childDetermined("A")[5]);
  EXPECT_TRUE(results.childDetermined("B")[5]);
  const auto& determined = results.dynamics.effortDetermined();
  EXPECT_EQ(std::count(determined.begin(), determined.end(), false), 2);
}

INSTANTIATE_TEST_SUITE_P(FourBar, EachCut, ::testing::Values('A', 'B', 'C', 'D'));

}  // namespace
}  // namespace virtual_work_dynamics
