#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "closed_loops.h"
#include "coupled_shafts.h"
#include "four_bar.h"
#include "result_differences.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Computes a scene with and without residuals: they are left out, found afterwards, and nothing
// else depends on them.
class WithAndWithoutResiduals {
 public:
  WithAndWithoutResiduals(const Mechanism& mechanism, const Scene& scene, Request request)
      : with_(mechanism, scene, request),
        without_(mechanism, scene, lean(request)),
        workspace_(without_.makeWorkspace()) {}

  // Returns what the first of them has.
  Results compute(const Motion& motion) {
    with_.compute(motion);
    without_.compute(motion, workspace_);
    Results all = with_.results();
    EXPECT_FALSE(all.loops.residuals.empty());
    EXPECT_TRUE(workspace_.results().loops.residuals.empty());
    EXPECT_TRUE(workspace_.results().loops.relative_residuals.empty());
    const Results lean_results = workspace_.results();
    Results found = lean_results;
    const ClosedLoopDynamics::Residuals residuals = without_.residualsOf(motion, workspace_);
    found.loops.residuals = residuals.plain;
    found.loops.relative_residuals = residuals.relative;
    EXPECT_EQ(differences(found, all), "");
    EXPECT_EQ(differences(workspace_.results(), lean_results), "");  // they stay
    return all;
  }

 private:
  static Request lean(Request request) {
    request.residuals = false;
    return request;
  }

  ClosedLoops with_;
  ClosedLoopDynamics without_;
  ClosedLoopDynamics::Workspace workspace_;
};

TEST(RequestedResiduals, AreLeftOutAndFoundAfterwards) {
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut('D');
  WithAndWithoutResiduals dynamics(cut.mechanism, cut.scene, {});
  Motion motion = cut.motion(four_bar.turnings(1.1, 3, -2));
  motion.q[0] += 0.01;
  motion.qd[0] += 0.1;
  motion.qdd[0] += 1;
  const ClosureResidual open = dynamics.compute(motion).loops.residuals[0];
  for (const double level : {open.position, open.velocity, open.acceleration}) {
    EXPECT_GT(level, 1e-4);
  }
  cut.scene.static_motion = true;
  WithAndWithoutResiduals still(cut.mechanism, cut.scene, {});
  EXPECT_EQ(still.compute(motion).loops.residuals[0].velocity, 0);
}

// Each of these results depends on velocities, which are found with the residuals or without.
TEST(RequestedResiduals, TwistsOfClosuresNeedNone) {
  const SliderCrank slider_crank;
  Request request;
  request.root_axes = {"pin"};
  request.twists = true;
  WithAndWithoutResiduals dynamics(slider_crank.mechanism(), slider_crank.scene("joint_1"),
                                   request);
  for (const double rate : {2.0, -3.0}) {
    const Motion motion = SliderCrank::motion(0.7, rate, 1);
    EXPECT_NEAR(dynamics.compute(motion).twists[0].linear.x(), motion.qd[2], 1e-13);
  }
}

TEST(RequestedResiduals, RatesOfActuatedClosuresNeedNone) {
  const Mechanism mechanism = sliderCrankOfPins(false);
  Scene scene;
  scene.closures = {slideOfPins(false)};
  scene.actuated = std::vector<std::string>{"slide"};
  const Motion start = SliderCrank::motion(0.7, 0, 0);
  const auto pinned = [](const Motion& slider) {
    Motion motion = slider;
    motion.q[2] = -slider.q[0] - slider.q[1];
    motion.qd[2] = -slider.qd[0] - slider.qd[1];
    motion.qdd[2] = -slider.qdd[0] - slider.qdd[1];
    return motion;
  };
  for (int i = 0; i < 3; ++i) {
    scene.assembly.push_back({"joint_" + std::to_string(i + 1), pinned(start).q[i]});
  }
  WithAndWithoutResiduals dynamics(mechanism, scene, {});
  for (const double rate : {2.0, -3.0}) {
    const Motion slider = SliderCrank::motion(0.7, rate, 1);
    EXPECT_NEAR(dynamics.compute(pinned(slider)).loops.actuated_velocities[0], slider.qd[2], 1e-13);
  }
}

TEST(RequestedResiduals, RatesOfCouplingsNeedNone) {
  CoupledShafts shafts({{10, false}, {100, false}});
  shafts.couple("belt", {{2, 1}, {1, 0.1}}).offset = 0;
  shafts.actuate(1);
  WithAndWithoutResiduals dynamics(shafts.mechanism(), shafts.scene, {});
  Motion motion(2);
  for (const double rate : {2.0, -3.0}) {
    motion.qd << 1, rate;
    EXPECT_NEAR(dynamics.compute(motion).loops.actuated_velocities[0], rate + 0.1, 1e-13);
  }
}

TEST(RequestedResiduals, DampersNeedNone) {
  const SliderCrank slider_crank;
  Scene scene = slider_crank.scene("joint_1");
  PointSpring strut;
  strut.name = "strut";
  strut.link_a = "link_0";
  strut.link_b = "link_3";
  strut.damping = 35;
  scene.springs = {strut};
  WithAndWithoutResiduals dynamics(slider_crank.mechanism(), scene, {});
  for (const double rate : {2.0, -3.0}) {
    const Motion motion = SliderCrank::motion(0.7, rate, 0);
    const Results results = dynamics.compute(motion);
    EXPECT_NEAR(results.loops.tree_wrenches[1].force.x(), -35 * motion.qd[2], 1e-11);
  }
}

// Why a motion does not close is said by what it leaves open.
TEST(RequestedResiduals, SaysWhyLoopsAreOpenWithoutThem) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  Request request;
  const Dynamics with(mechanism, slider_crank.scene("joint_3"), request);
  request.residuals = false;
  const Dynamics without(mechanism, slider_crank.scene("joint_3"), request);
  Motion motion = SliderCrank::motion(0.1, 0, 0);
  motion.q[2] += 0.25;
  Dynamics::Workspace with_residuals = with.makeWorkspace(), plain = without.makeWorkspace();
  const std::string why = without.whyOpen(motion, plain);
  EXPECT_EQ(why, with.whyOpen(motion, with_residuals));
  EXPECT_NE(why.find("closure 'pin' stays open by 0.2"), std::string::npos) << why;
}

TEST(RequestedResiduals, RefusesWhatComputeRefuses) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  const Scene scene = slider_crank.scene("joint_1");
  const ClosedLoopDynamics dynamics(mechanism, scene, {}), other(mechanism, scene, {});
  ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
  ClosedLoopDynamics::Workspace of_other = other.makeWorkspace();
  EXPECT_THROW(dynamics.residualsOf(Motion(2), workspace), MotionError);
  EXPECT_THROW(dynamics.residualsOf(Motion(3), of_other), MotionError);
}

}  // namespace
}  // namespace virtual_work_dynamics
