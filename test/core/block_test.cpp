#include "virtual_work_dynamics/block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "plain_results.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr BlockLayout kLayouts[] = {BlockLayout::kStructureOfArrays, BlockLayout::kRowMajor};

std::size_t widthOf(InstructionSet set, std::size_t size_of_number) {
  const std::size_t bytes = set == InstructionSet::kBaseline ? 16
                            : set == InstructionSet::kAvx2   ? 32
                                                             : 64;
  return bytes / size_of_number;
}

// Every kind of joint, with a wrench on a link in either axes.
struct Tree {
  RandomRobot random;
  Mechanism mechanism;
  Scene scene;

  explicit Tree(unsigned seed, int links = 16)
      : random(seed, links), mechanism(readUrdf(random.urdf())) {
    scene.gravity = {0.7, -2, -9};
    scene.include_active = seed % 2 == 0;
    scene.static_motion = seed % 7 == 3;
    scene.applied_wrenches.resize(2);
    for (int i = 0; i < 2; ++i) {
      AppliedWrench& wrench = scene.applied_wrenches[static_cast<std::size_t>(i)];
      wrench.link = "link_" + std::to_string(links - 1 - i);
      wrench.axes = i == 0 ? Axes::kLink : Axes::kRoot;
      wrench.at << 0.1, -0.2, 0.3;
      wrench.force << 10, 20, -30;
      wrench.torque << 1, -2, 3;
    }
  }

  // Some angles beyond the kernels' own reduction.
  std::vector<Motion> motions(std::size_t count) {
    std::vector<Motion> motions;
    for (std::size_t n = 0; n < count; ++n) {
      motions.push_back(random.motion(mechanism));
      if (n % 5 == 3)
        motions.back().q[static_cast<Eigen::Index>(n) % motions.back().q.size()] *= 1e8;
    }
    return motions;
  }
};

// Every sample in a block of its own.
template <typename Real>
std::vector<PlainResults<Real>> oneByOne(const InverseDynamics& dynamics,
                                         const std::vector<Motion>& motions, InstructionSet set) {
  std::vector<PlainResults<Real>> results;
  BlockInverseDynamics<Real> block(dynamics, 1, set);
  for (const Motion& motion : motions) {
    results.push_back(blockResults(block, {motion}, BlockLayout::kStructureOfArrays)[0]);
  }
  return results;
}

template <typename Real>
void expectSame(const std::vector<PlainResults<Real>>& results,
                const std::vector<PlainResults<Real>>& expected) {
  ASSERT_LE(results.size(), expected.size());
  for (std::size_t n = 0; n < results.size(); ++n) {
    EXPECT_EQ(differences(results[n], expected[n]), "") << "sample " << n;
  }
}

template <typename Real>
void expectNoMatterHow(const Mechanism& mechanism, const Scene& scene,
                       const std::vector<Motion>& motions, int most_threads) {
  for (const InstructionSet set : supportedInstructionSets()) {
    const InverseDynamics dynamics(mechanism, scene, requestAll(mechanism), set);
    const std::vector<PlainResults<Real>> expected = oneByOne<Real>(dynamics, motions, set);
    const std::size_t width = widthOf(set, sizeof(Real));
    for (const std::size_t samples : {std::size_t(0), std::size_t(1), width - 1, width, width + 1,
                                      3 * width - 1, motions.size()}) {
      const std::vector<Motion> first(motions.begin(), motions.begin() + samples);
      for (const BlockLayout layout : kLayouts) {
        for (int threads = 1; threads <= most_threads; ++threads) {
          SCOPED_TRACE(toString(set) + ", samples " + std::to_string(samples) + ", layout " +
                       std::to_string(static_cast<int>(layout)) + ", threads " +
                       std::to_string(threads));
          expectSame(blockResults<Real>(dynamics, first, layout, threads, set), expected);
        }
      }
    }
  }
}

TEST(Block, SamplesDoNotDependOnLayoutPlaceOrThreads) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Tree tree(seed);
    const std::vector<Motion> motions = tree.motions(seed == 1 ? 1000 : 50);
    expectNoMatterHow<double>(tree.mechanism, tree.scene, motions, 3);
    expectNoMatterHow<float>(tree.mechanism, tree.scene, motions, 3);
  }
}

// Fewer and more coordinates than samples of a pack: all ways through the transposes.
TEST(Block, AnyNumberOfColumns) {
  for (const int joints : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 15, 16, 17, 24, 31, 33}) {
    SCOPED_TRACE(joints);
    RobotBuilder chain = chainOf(joints);
    const std::vector<Motion> motions = chain.motions(50);
    expectNoMatterHow<double>(chain.build(), Scene(), motions, 1);
    expectNoMatterHow<float>(chain.build(), Scene(), motions, 1);
  }
}

TEST(Block, IsTheSingleSampleBitForBit) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Tree tree(seed);
    const std::vector<Motion> motions = tree.motions(20);
    for (const InstructionSet set : supportedInstructionSets()) {
      SCOPED_TRACE(toString(set));
      const InverseDynamics dynamics(tree.mechanism, tree.scene, requestEveryJoint(tree.mechanism),
                                     set);
      const auto block = blockResults<double>(dynamics, motions, BlockLayout::kRowMajor, 1, set);
      for (std::size_t n = 0; n < motions.size(); ++n) {
        PlainResults<double> single = singleResults(dynamics, motions[n]);
        single.poses = block[n].poses;  // a Workspace has quaternions
        EXPECT_EQ(differences(block[n], single), "") << "sample " << n;
      }
    }
  }
}

// A quaternion is made from the matrix by two dozen operations on numbers up to 1.
constexpr double kQuaternion = 8 * std::numeric_limits<double>::epsilon();

TEST(Block, PosesAreTheSingleSamples) {
  Tree tree(4);
  const std::vector<Motion> motions = tree.motions(10);
  const InverseDynamics dynamics(tree.mechanism, tree.scene, requestEveryJoint(tree.mechanism));
  const auto block = blockResults<double>(dynamics, motions, BlockLayout::kStructureOfArrays, 1,
                                          chosenInstructionSet());
  Workspace workspace = dynamics.makeWorkspace();
  for (std::size_t n = 0; n < motions.size(); ++n) {
    dynamics.compute(motions[n], workspace);
    ASSERT_EQ(block[n].poses.size(), 12 * workspace.poses().size());
    for (std::size_t i = 0; i < workspace.poses().size(); ++i) {
      const Pose& pose = workspace.poses()[i];
      const double* const numbers = &block[n].poses[12 * i];
      EXPECT_EQ(Eigen::Map<const Eigen::Vector3d>(numbers), pose.position);
      using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
      const Eigen::Matrix3d R = Eigen::Map<const RowMajor>(numbers + 3);
      EXPECT_LE((R - pose.orientation.toRotationMatrix()).cwiseAbs().maxCoeff(), kQuaternion);
    }
  }
}

template <typename Real>
void expectFusedBuildsAgree() {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Tree tree(seed, 20);
    const std::vector<Motion> motions = tree.motions(40);
    const InverseDynamics dynamics(tree.mechanism, tree.scene, requestEveryJoint(tree.mechanism));
    for (const BlockLayout layout : kLayouts) {
      expectSame(blockResults<Real>(dynamics, motions, layout, 1, InstructionSet::kAvx512),
                 blockResults<Real>(dynamics, motions, layout, 1, InstructionSet::kAvx2));
    }
  }
}

TEST(Block, BuildsWithFusedMultiplyAddAgreeBitForBit) {
  if (!isSupported(InstructionSet::kAvx2) || !isSupported(InstructionSet::kAvx512)) {
    GTEST_SKIP() << "this machine has not both builds";
  }
  expectFusedBuildsAgree<double>();
  expectFusedBuildsAgree<float>();
}

// Reading or writing before the arrays crashes here, behind them everywhere else.
TEST(Block, KeepsWithinItsArrays) {
  for (const int joints : {1, 2, 3, 7, 9, 16, 17}) {
    RobotBuilder chain = chainOf(joints);
    const Mechanism mechanism = chain.build();
    const InverseDynamics dynamics(mechanism, Scene(), requestAll(mechanism));
    for (const InstructionSet set : supportedInstructionSets()) {
      for (const std::size_t samples : {1, 2, 3, 7, 9, 15, 16, 17, 33}) {
        for (const BlockLayout layout : kLayouts) {
          BlockInverseDynamics<double> block(dynamics, 2, set);
          blockResults(block, chain.motions(samples), layout, FencedArray<double>::kFenceBefore);
          BlockInverseDynamics<float> block_float(dynamics, 2, set);
          blockResults(block_float, chain.motions(samples), layout,
                       FencedArray<float>::kFenceBefore);
        }
      }
    }
  }
}

// Each output alone, the other arrays null: the same bits as all together, and nothing else
// written.
TEST(Block, NullOutputsAreSkipped) {
  Tree tree(5);
  const std::vector<Motion> motions = tree.motions(37);
  const InverseDynamics dynamics(tree.mechanism, tree.scene, requestEveryJoint(tree.mechanism));
  for (const InstructionSet set : supportedInstructionSets()) {
    BlockInverseDynamics<double> block(dynamics, 1, set);
    for (const BlockLayout layout : kLayouts) {
      const auto all = blockResults(block, motions, layout);
      for (int wanted = 0; wanted < 6; ++wanted) {
        FencedBlock<double> arrays(block, motions, layout);
        ResultBlock<double> out = arrays.out();
        if (wanted != 0) out.effort = nullptr;
        if (wanted != 1) out.child_axes = nullptr;
        if (wanted != 2) out.root_axes = nullptr;
        if (wanted != 3) out.poses = nullptr;
        if (wanted != 4) out.twists = nullptr;
        std::vector<PlainResults<double>> expected;
        for (std::size_t n = 0; n < motions.size(); ++n) expected.push_back(arrays.sample(n));
        block.compute(layout, arrays.in(), out);
        EXPECT_TRUE(arrays.surroundingsUntouched());
        for (std::size_t n = 0; n < motions.size(); ++n) {
          if (wanted == 0) expected[n].effort = all[n].effort;
          if (wanted == 1) expected[n].child_axes = all[n].child_axes;
          if (wanted == 2) expected[n].root_axes = all[n].root_axes;
          if (wanted == 3) expected[n].poses = all[n].poses;
          if (wanted == 4) expected[n].twists = all[n].twists;
          EXPECT_EQ(differences(arrays.sample(n), expected[n]), "")
              << toString(set) << ": only output " << wanted;
        }
      }
    }
  }
}

TEST(Block, ABadSampleLeavesItsNeighboursAlone) {
  Tree tree(6);
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Motion> good = tree.motions(40);
  const InverseDynamics dynamics(tree.mechanism, tree.scene, requestAll(tree.mechanism));
  for (const InstructionSet set : supportedInstructionSets()) {
    BlockInverseDynamics<double> block(dynamics, 1, set);
    for (const BlockLayout layout : kLayouts) {
      const auto expected = blockResults(block, good, layout);
      for (const double bad : {inf, -inf, std::numeric_limits<double>::quiet_NaN(), 1e300}) {
        for (Eigen::VectorXd Motion::*vector : {&Motion::q, &Motion::qd, &Motion::qdd}) {
          std::vector<Motion> motions = good;
          (motions[11].*vector)[0] = bad;
          (motions[38].*vector)[0] = bad;
          const auto results = blockResults(block, motions, layout);
          for (std::size_t n = 0; n < motions.size(); ++n) {
            EXPECT_EQ(differences(results[n], expected[n]).empty(), n != 11 && n != 38)
                << toString(set) << ", sample " << n << ", " << bad;
          }
        }
      }
      // Nothing lingers.
      expectSame(blockResults(block, good, layout), expected);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
