#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "loop_examples.h"
#include "ros/cross_check.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Rounding error of each of the steps that lead to a result.
constexpr double kStep = 4 * std::numeric_limits<double>::epsilon();
// The planted error, relative to a value whose sum of magnitudes may be larger.
constexpr double kTampered = 1e-6;
constexpr double kShare = 1e-3;
// Least share of a closure's wrench in the sums of passive joints, in the examples.
constexpr double kLeastShare = 1e-3;
// Share of an error that must be seen; rounding errors may cancel the rest.
constexpr double kMost = 0.9;
// The longest way through the examples' trees has a dozen steps.
constexpr double kSoundest = 12 * kStep;

/// A sample of one of the package's examples, right until something is changed.
struct LoopSample {
  LoopSample(const LoopExample& wanted, const Motion& at, const Request& extra = Request())
      : example(wanted),
        request(requestOf(example, extra)),
        dynamics(example.mechanism, example.scene, request),
        motion(at),
        slot(example.mechanism, dynamics) {
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    results = workspace.results();
  }

  static Request requestOf(const LoopExample& example, Request request) {
    const auto reactions = requestedReactions(example.mechanism, example.scene);
    auto& names = request.child_axes;
    for (const std::string& name : reactions) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    request.root_axes = reactions;
    request.root_axes.push_back(kGround);
    return request;
  }

  CrossCheckSlot::Finding check() {
    EXPECT_TRUE(slot.offer(motion, Load(), results));
    return slot.check().value_or(CrossCheckSlot::Finding());
  }

  double bound() const {
    const ErrorBound tree(example.mechanism, dynamics.tree());
    return kStep * *std::max_element(tree.depths().begin(), tree.depths().end());
  }

  LoopExample example;
  Request request;
  Dynamics dynamics;
  Motion motion;
  Results results;
  CrossCheckSlot slot;
};

struct NamedMotion {
  const char* name;
  Positions (*positions)(long double);
};

constexpr NamedMotion kExamples[] = {{"four_bar", fourBarAt},
                                     {"slider_crank", sliderCrankAt},
                                     {"planar_3rrr", planar3rrrAt},
                                     {"stewart_gough", stewartGoughAt},
                                     {"spatial_parallelogram", parallelogramAt},
                                     {"andrews_squeezer", andrewsAt}};

void expectSound(const LoopExample& example, const Motion& motion, const char* what) {
  LoopSample sample(example, motion);
  ASSERT_EQ(sample.results.loops.determinacy.free_motions, 0) << what;
  const CrossCheckSlot::Finding finding = sample.check();
  EXPECT_LE(finding.largest, sample.bound()) << what << ": " << finding.where;
  EXPECT_GT(finding.largest, 0) << what;
}

TEST(LoopCrossCheck, SoundResultsDifferByRoundingErrorsOfTheTree) {
  for (const NamedMotion& named : kExamples) {
    LoopExample example(named.name);
    for (const long double t : {0.1L, 0.45L, 0.8L}) {
      const Motion motion = motionAt(example.mechanism, named.positions, t);
      expectSound(example, motion, named.name);
      // A motion that violates the loops is checked as it is.
      Motion violating = motion;
      violating.q[violating.q.size() - 1] += 0.01;
      violating.qd[0] += 0.1;
      expectSound(example, violating, named.name);
      LoopExample other = example;
      other.scene.include_active = false;
      other.scene.moments_about = {{other.mechanism.coordinateNames().back(),
                                    JointFrame::kChild,
                                    other.mechanism.link(0).name,
                                    {0.3, -0.2, 5}}};
      other.scene.static_motion = true;
      expectSound(other, motion, named.name);
    }
  }
}

LoopExample loadedSliderCrank() {
  LoopExample example("slider_crank");
  AppliedWrench push;
  push.link = "slider";
  push.at << 0.1, -0.2, 0.3;
  push.force << 30, -20, 10;
  push.torque << 1, 2, -3;
  example.scene.applied_wrenches.push_back(push);
  PointSpring spring;
  spring.name = "spring";
  spring.link_a = example.mechanism.links()[0].name;
  spring.link_b = "rod";
  spring.at_a << 0.2, 0.3, 0;
  spring.stiffness = 400;
  example.scene.springs.push_back(spring);
  return example;
}

TEST(LoopCrossCheck, SpringsAndActuatedClosuresAreSoundToo) {
  LoopExample example = loadedSliderCrank();
  const Motion motion = motionAt(example.mechanism, sliderCrankAt, 0.3L);
  expectSound(example, motion, "by the crank");
  example.scene.actuated = std::vector<std::string>{example.scene.closures[0].name};
  expectSound(example, motion, "by the pin");
  EXPECT_EQ(LoopSample(example, motion).results.effort.size(), 4);
}

TEST(LoopCrossCheck, WithoutEffortsAndWithGroundAndClosuresFirst) {
  const LoopExample example = loadedSliderCrank();
  Request request;
  request.efforts = false;
  request.child_axes = {kGround, example.scene.closures[0].name};
  LoopSample sample(example, motionAt(example.mechanism, sliderCrankAt, 0.3L), request);
  EXPECT_LE(sample.check().largest, sample.bound());
  // Reactions of closures are taken over, not compared.
  sample.results.child_axes[1].force[0] += 1;
  EXPECT_LE(sample.check().largest, sample.bound());
  sample.results.child_axes[2].force[0] += 1;
  EXPECT_EQ(sample.check().where, "force at " + sample.request.child_axes[2]);
}

TEST(LoopCrossCheck, NamesEffortsOfPassiveJointsThatDoNotVanish) {
  for (const NamedMotion& named : kExamples) {
    LoopExample example(named.name);
    LoopSample sample(example, motionAt(example.mechanism, named.positions, 0.45L));
    ErrorBound bound(example.mechanism, sample.dynamics.tree());
    Load load;
    sample.dynamics.getTreeLoad(sample.results, load);
    bound.compute(sample.motion, load);
    for (Eigen::Index i = 0; i < sample.motion.q.size(); ++i) {
      const auto place = static_cast<std::size_t>(i);
      const double before = sample.results.effort[i];
      EXPECT_TRUE(sample.dynamics.actuated()[place] || before == 0);
      sample.results.effort[i] += kTampered * bound.efforts()[place];
      const CrossCheckSlot::Finding finding = sample.check();
      EXPECT_EQ(finding.where, "effort of " + example.mechanism.coordinateNames()[place]);
      EXPECT_NEAR(finding.largest, kTampered, kShare * kTampered);
      sample.results.effort[i] = before;
    }
  }
}

// Computes results with the wrench of one closure scaled. Only the efforts of passive joints, which
// should vanish, can show that.
CrossCheckSlot::Finding withLastClosureScaled(const NamedMotion& named, double scale) {
  const LoopExample example(named.name);
  const Mechanism& mechanism = example.mechanism;
  const Motion motion = motionAt(mechanism, named.positions, 0.45L);
  Request request;
  for (const Joint& joint : mechanism.joints()) request.root_axes.push_back(joint.name);
  request.child_axes = {kGround};
  const Dynamics loops(mechanism, example.scene, request);
  Dynamics::Workspace workspace = loops.makeWorkspace();
  loops.compute(motion, workspace);
  Results tampered = workspace.results();
  Load load;
  loops.getTreeLoad(tampered, load);
  for (std::size_t i = load.wrenches.size() - 2; i < load.wrenches.size(); ++i) {
    load.wrenches[i].force *= scale;
    load.wrenches[i].torque *= scale;
  }
  const InverseDynamics tree(mechanism, loops.tree(), request);
  Workspace results = tree.makeWorkspace();
  tree.compute(motion, load, results);
  tampered.effort = results.effort();
  for (std::size_t i = 0; i < loops.actuated().size(); ++i) {
    if (!loops.actuated()[i]) tampered.effort[static_cast<Eigen::Index>(i)] = 0;
  }
  tampered.child_axes = results.childAxes();
  tampered.root_axes = results.rootAxes();
  tampered.loops.tree_wrenches = load.wrenches;
  CrossCheckSlot slot(mechanism, loops);
  EXPECT_TRUE(slot.offer(motion, Load(), tampered));
  const CrossCheckSlot::Finding finding = slot.check().value_or(CrossCheckSlot::Finding());
  for (std::size_t i = 0; i < loops.actuated().size(); ++i) {
    if (!loops.actuated()[i] && finding.where == "effort of " + mechanism.coordinateNames()[i]) {
      return finding;
    }
  }
  EXPECT_EQ(scale, 1) << named.name << ": " << finding.where << " is to blame";
  return finding;
}

TEST(LoopCrossCheck, WrenchesThatAreNoSolutionShowInPassiveJoints) {
  for (const NamedMotion& named : kExamples) {
    EXPECT_LE(withLastClosureScaled(named, 1).largest, kSoundest) << named.name;
    const double off = withLastClosureScaled(named, 1 + kTampered).largest;
    EXPECT_GT(off, kLeastShare * kTampered) << named.name;
    EXPECT_LE(off, kTampered) << named.name;
    EXPECT_GT(withLastClosureScaled(named, -1).largest, kLeastShare) << named.name;
  }
}

TEST(LoopCrossCheck, WrenchesOtherThanThoseOfTheResultsShow) {
  for (const NamedMotion& named : kExamples) {
    const LoopExample example(named.name);
    LoopSample sample(example, motionAt(example.mechanism, named.positions, 0.45L));
    ErrorBound bound(example.mechanism, sample.dynamics.tree());
    Load load;
    sample.dynamics.getTreeLoad(sample.results, load);
    bound.compute(sample.motion, load);
    for (Wrench& wrench : sample.results.loops.tree_wrenches) {
      // Ground has to bear what the opposite wrench does not.
      const Wrench sound = wrench;
      const double share = kMost * sound.force.norm() / bound.wrenches()[0].force;
      EXPECT_GT(kTampered * share, sample.bound()) << named.name;
      wrench.force *= 1 + kTampered;
      EXPECT_GT(sample.check().largest, kTampered * share) << named.name;
      wrench.force = -sound.force;
      EXPECT_GT(sample.check().largest, 2 * share) << named.name;
      wrench = sound;
    }
    EXPECT_LE(sample.check().largest, sample.bound()) << named.name;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
