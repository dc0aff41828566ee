#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "four_bar.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Of the largest force or moment; a handful of roundings in a well-conditioned system.
constexpr double kPlanarTolerance = 1e-12;
// The same results by other trees and units.
constexpr double kInvariance = 1e-12;

Request everythingOf(const Mechanism& mechanism, const Scene& scene) {
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  return request;
}

// One sample of a linkage cut somewhere.
struct Sample {
  Sample(const FourBar& four_bar, const FourBar::Cut& cut, const FourBar::Turnings& turnings)
      : dynamics(cut.mechanism, cut.scene, everythingOf(cut.mechanism, cut.scene)),
        forces(four_bar.freeBodies(turnings)) {
    dynamics.compute(cut.motion(turnings));
  }
  const Wrench& child(char pivot) const { return dynamics.childAxes()[indexOf(pivot)]; }
  const Determined& determined(char pivot) const {
    return dynamics.childAxesDetermined()[indexOf(pivot)];
  }
  std::size_t indexOf(char pivot) const {
    const auto& names = dynamics.request().child_axes;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), std::string(1, pivot)) -
                                    names.begin());
  }
  double torque() const { return dynamics.effort().sum(); }

  ClosedLoopDynamics dynamics;
  FourBar::Forces forces;
};

// In-plane force on the child of a joint in the child's axes, from the free bodies.
FourBar::Vector2 expected(const FourBar::Forces& forces, const FourBar::Turnings& turnings,
                          const FourBar::Cut::Hanging& joint) {
  const bool other = (joint.pivot == 'B' && joint.body == FourBar::kCrank) ||
                     (joint.pivot == 'C' && joint.body == FourBar::kCoupler);
  const FourBar::Vector2 force = (other ? -1 : 1) * forces.on_body.at(joint.pivot);
  const auto angle = turnings[static_cast<std::size_t>(joint.body)].angle;
  return {force.dot(FourBar::along(angle)), force.dot(FourBar::normal(angle))};
}

std::vector<FourBar::Cut::Hanging> allJoints(const FourBar::Cut& cut) {
  auto joints = cut.joints;
  joints.push_back(cut.closure);
  return joints;
}

class EachCut : public ::testing::TestWithParam<char> {};

TEST_P(EachCut, InPlaneForcesAndTorqueEqualThoseOfTheFreeBodies) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  for (const double angle : {0.3, 1.1, 2.5, 4.0, 5.7}) {
    const auto turnings = four_bar.turnings(angle, 3.1, -4.2);
    const Sample sample(four_bar, cut, turnings);
    double largest = std::abs(static_cast<double>(sample.forces.torque));
    for (const auto& force : sample.forces.on_body) {
      largest = std::max(largest, static_cast<double>(force.second.norm()));
    }
    for (const auto& joint : allJoints(cut)) {
      const Wrench& wrench = sample.child(joint.pivot);
      const auto force = expected(sample.forces, turnings, joint);
      EXPECT_NEAR(wrench.force.x(), static_cast<double>(force.x()), kPlanarTolerance * largest);
      EXPECT_NEAR(wrench.force.y(), static_cast<double>(force.y()), kPlanarTolerance * largest);
      const double torque = joint.pivot == 'A' ? static_cast<double>(sample.forces.torque) : 0;
      EXPECT_NEAR(wrench.torque.z(), torque, kPlanarTolerance * largest);
    }
    EXPECT_NEAR(sample.torque(), static_cast<double>(sample.forces.torque),
                kPlanarTolerance * largest);
    EXPECT_TRUE(sample.dynamics.finite());
  }
}

TEST_P(EachCut, ThreeConstraintsAreRedundantAndFlagTheOutOfPlaneReactions) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  const Sample sample(four_bar, cut, four_bar.turnings(1.1, 3.1, -4.2));
  const Determinacy& determinacy = sample.dynamics.determinacy();
  EXPECT_EQ(determinacy.redundant_constraints, 3);
  EXPECT_EQ(determinacy.redundancy, 3);
  EXPECT_EQ(determinacy.rank, 3);
  EXPECT_EQ(determinacy.free_motions, 0);
  EXPECT_GT(determinacy.gap, 1e10);
  EXPECT_LT(determinacy.condition, 100);
  for (const char pivot : {'A', 'B', 'C', 'D'}) {
    EXPECT_EQ(sample.determined(pivot), (Determined{true, true, false, false, false, true}));
  }
  for (const bool determined : sample.dynamics.effortDetermined()) EXPECT_TRUE(determined);
}

INSTANTIATE_TEST_SUITE_P(FourBar, EachCut, ::testing::Values('A', 'B', 'C', 'D'));

}  // namespace
}  // namespace virtual_work_dynamics
