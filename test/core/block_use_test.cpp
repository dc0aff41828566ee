#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "plain_results.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr BlockLayout kLayouts[] = {BlockLayout::kStructureOfArrays, BlockLayout::kRowMajor};

std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const MotionError& error) {
    return std::string("MotionError: ") + error.what();
  } catch (const SceneError& error) {
    return std::string("SceneError: ") + error.what();
  } catch (const Error& error) {
    return std::string("Error: ") + error.what();
  }
  return "";
}

struct Chain {
  RobotBuilder builder = chainOf(3);
  Mechanism mechanism = builder.build();

  InverseDynamics dynamics(const Request& request) const {
    return InverseDynamics(mechanism, Scene(), request);
  }
};

TEST(BlockUse, TellsWhatItIs) {
  const Chain chain;
  Request request;
  request.root_axes = {"joint_2"};
  for (const InstructionSet set : supportedInstructionSets()) {
    const BlockInverseDynamics<double> block(chain.dynamics(request), 3, set);
    EXPECT_EQ(block.coordinates(), 3u);
    EXPECT_EQ(block.threads(), 3);
    EXPECT_EQ(block.instructionSet(), set);
    EXPECT_EQ(block.request().root_axes, request.root_axes);
  }
  const BlockInverseDynamics<float> chosen(chain.dynamics(request));
  EXPECT_EQ(chosen.threads(), 1);
  EXPECT_EQ(chosen.instructionSet(), chosenInstructionSet());
}

TEST(BlockUse, MissingInputsAreNamed) {
  Chain chain;
  BlockInverseDynamics<double> block(chain.dynamics(Request()));
  for (const BlockLayout layout : kLayouts) {
    FencedBlock<double> arrays(block, chain.builder.motions(9), layout);
    const auto compute = [&](const double* MotionBlock<double>::*missing) {
      MotionBlock<double> in = arrays.in();
      in.*missing = nullptr;
      return messageOf([&] { block.compute(layout, in, arrays.out()); });
    };
    EXPECT_EQ(compute(&MotionBlock<double>::q), "MotionError: block: q is missing");
    EXPECT_EQ(compute(&MotionBlock<double>::qd), "MotionError: block: qd is missing");
    EXPECT_EQ(compute(&MotionBlock<double>::qdd), "MotionError: block: qdd is missing");
  }
}

TEST(BlockUse, OutputsThatWereNotRequestedAreNamed) {
  Chain chain;
  Request request;
  request.efforts = false;
  BlockInverseDynamics<float> block(chain.dynamics(request));
  FencedBlock<float> arrays(block, chain.builder.motions(9), BlockLayout::kRowMajor);
  float numbers[9];
  const auto compute = [&](float* ResultBlock<float>::*output) {
    ResultBlock<float> out;
    out.*output = numbers;
    return messageOf([&] { block.compute(BlockLayout::kRowMajor, arrays.in(), out); });
  };
  EXPECT_EQ(compute(&ResultBlock<float>::effort), "MotionError: block: effort was not requested");
  EXPECT_EQ(compute(&ResultBlock<float>::child_axes),
            "MotionError: block: child_axes was not requested");
  EXPECT_EQ(compute(&ResultBlock<float>::root_axes),
            "MotionError: block: root_axes was not requested");
  EXPECT_EQ(compute(&ResultBlock<float>::poses), "MotionError: block: poses was not requested");
  EXPECT_EQ(compute(&ResultBlock<float>::twists), "MotionError: block: twists was not requested");
}

TEST(BlockUse, ThreadsAndInstructionSetAreChecked) {
  const Chain chain;
  const InverseDynamics dynamics = chain.dynamics(Request());
  for (const int threads : {0, -1}) {
    EXPECT_EQ(messageOf([&] { BlockInverseDynamics<double>(dynamics, threads); }),
              "Error: blocks: " + std::to_string(threads) + " threads; at least 1 is needed");
  }
  // Not the last value, whichever machine this is.
  constexpr auto kNone = static_cast<InstructionSet>(77);
  EXPECT_NE(messageOf([&] { BlockInverseDynamics<double>(dynamics, 1, kNone); }), "");
  EXPECT_NE(messageOf([&] { BlockInverseDynamics<float>(dynamics, 1, kNone); }), "");
}

// No sample asks for no array.
TEST(BlockUse, NoSamplesNeedNoArrays) {
  const Chain chain;
  for (const int threads : {1, 2}) {
    BlockInverseDynamics<double> block(chain.dynamics(Request()), threads);
    for (const BlockLayout layout : kLayouts) EXPECT_NO_THROW(block.compute(layout, {}, {}));
  }
}

// A robot that cannot move still has reactions, and inputs that nobody has to give.
TEST(BlockUse, NoCoordinatesNeedNoInputs) {
  RobotBuilder builder(1);
  const Matrix3l R_PK = builder.rotation();
  builder.add(JointType::kFixed, 0, Vector3l::Zero(), R_PK, {0.1, 0.2, 0.3});
  const Mechanism mechanism = builder.build();
  const std::vector<Motion> motions(21, Motion(0));
  for (const InstructionSet set : supportedInstructionSets()) {
    const InverseDynamics dynamics(mechanism, Scene(), requestEveryJoint(mechanism), set);
    PlainResults<double> expected = singleResults(dynamics, motions[0]);
    for (const BlockLayout layout : kLayouts) {
      const auto results = blockResults<double>(dynamics, motions, layout, 2, set);
      for (const auto& sample : results) {
        expected.poses = sample.poses;
        EXPECT_EQ(differences(sample, expected), "");
      }
    }
  }
}

Scene sceneWithWrenches() {
  Scene scene;
  scene.applied_wrenches.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    AppliedWrench& wrench = scene.applied_wrenches[i];
    wrench.link = i == 2 ? "link_0" : "link_3";
    wrench.axes = i == 0 ? Axes::kLink : Axes::kRoot;
    wrench.at << 0.3, -0.1, 0.2;
    wrench.force << 1, 2, 3;
    wrench.torque << -3, 2, 5;
  }
  return scene;
}

template <typename Real>
void expectReplacedWrenches() {
  Chain chain;
  Scene scene = sceneWithWrenches();
  const Request request = requestEveryJoint(chain.mechanism);
  const std::vector<Motion> motions = chain.builder.motions(20);
  for (const InstructionSet set : supportedInstructionSets()) {
    for (const int threads : {1, 2}) {
      const InverseDynamics before(chain.mechanism, scene, request);
      BlockInverseDynamics<Real> replaced(before, threads, set);
      Scene other = scene;
      for (std::size_t i = 0; i < 3; ++i) {
        AppliedWrench& wrench = other.applied_wrenches[i];
        wrench.force << -7, static_cast<double>(i), 4;
        wrench.torque << 1, 8, -static_cast<double>(i);
      }
      const InverseDynamics after(chain.mechanism, other, request);
      const auto expected = blockResults<Real>(after, motions, kLayouts[0], threads, set);
      const auto old = blockResults<Real>(before, motions, kLayouts[0], threads, set);
      Load load(other);
      const auto results = blockResults(replaced, motions, kLayouts[0], load);
      const auto own = blockResults(replaced, motions, kLayouts[0]);
      for (std::size_t n = 0; n < motions.size(); ++n) {
        EXPECT_EQ(differences(results[n], expected[n]), "");
        EXPECT_NE(differences(results[n], old[n]), "");
        EXPECT_EQ(differences(own[n], old[n]), "");
      }
      load.wrenches.resize(4);
      EXPECT_EQ(messageOf([&] { blockResults(replaced, motions, kLayouts[0], load); }),
                "SceneError: load: it has 4 wrenches, the scene has 3 applied wrenches");
    }
  }
}

template <typename Real>
void expectLoadsOfSamples() {
  Chain chain;
  const Scene scene = sceneWithWrenches();
  const std::vector<Motion> motions = chain.builder.motions(21);
  std::vector<Load> loads;
  for (std::size_t n = 0; n < motions.size(); ++n) {
    loads.emplace_back(scene);
    for (Wrench& wrench : loads.back().wrenches) wrench.force *= static_cast<double>(n) - 7;
  }
  const InverseDynamics dynamics(chain.mechanism, scene, requestEveryJoint(chain.mechanism));
  for (const InstructionSet set : supportedInstructionSets()) {
    for (const BlockLayout layout : kLayouts) {
      BlockInverseDynamics<Real> block(dynamics, 2, set);
      const auto results =
          blockResults(block, motions, layout, static_cast<const Load*>(loads.data()));
      for (std::size_t n = 0; n < motions.size(); ++n) {
        const auto expected = blockResults(block, {motions[n]}, layout, loads[n]);
        EXPECT_EQ(differences(results[n], expected[0]), "") << n;
      }
    }
  }
}

TEST(BlockUse, EachSampleMayHaveALoadOfItsOwn) {
  expectLoadsOfSamples<double>();
  expectLoadsOfSamples<float>();
}

TEST(BlockUse, ALoadReplacesTheAppliedWrenchesOfOneBlock) {
  expectReplacedWrenches<double>();
  expectReplacedWrenches<float>();
}

TEST(BlockUse, OutlivesThePlanAndSurvivesMoves) {
  Chain chain;
  const std::vector<Motion> motions = chain.builder.motions(50);
  const Request request = requestAll(chain.mechanism);
  const auto expected = blockResults<double>(chain.dynamics(request), motions, kLayouts[1], 1,
                                             chosenInstructionSet());
  const auto expectSame = [&](BlockInverseDynamics<double>& block) {
    const auto results = blockResults(block, motions, kLayouts[1]);
    for (std::size_t n = 0; n < motions.size(); ++n) {
      EXPECT_EQ(differences(results[n], expected[n]), "");
    }
  };
  for (const int threads : {1, 3}) {
    BlockInverseDynamics<double> first(chain.dynamics(request), threads);
    expectSame(first);
    BlockInverseDynamics<double> second(std::move(first));
    expectSame(second);
    first = BlockInverseDynamics<double>(chain.dynamics(Request()), threads);  // filled anew
    first = std::move(second);
    expectSame(first);
    EXPECT_EQ(first.threads(), threads);
  }
}

// Whoever moves a plan may go on with its workspaces.
TEST(BlockUse, PlansAndWorkspacesSurviveMoves) {
  Chain chain;
  const Motion motion = chain.builder.motion();
  const Request request = requestAll(chain.mechanism);
  InverseDynamics first = chain.dynamics(request);
  Workspace made_first = first.makeWorkspace();
  first.compute(motion, made_first);
  const PlainResults<double> expected = singleResults(made_first);
  InverseDynamics second(std::move(first));
  Workspace workspace(std::move(made_first));
  const Motion rest(3);
  second.compute(rest, workspace);
  EXPECT_NE(differences(singleResults(workspace), expected), "");
  second.compute(motion, workspace);
  EXPECT_EQ(differences(singleResults(workspace), expected), "");
  first = std::move(second);
  first.compute(motion, workspace);
  EXPECT_EQ(differences(singleResults(workspace), expected), "");
}

// Threads that sleep between blocks wake for each, whatever its size.
TEST(BlockUse, ThreadsServeManyBlocks) {
  Chain chain;
  const InverseDynamics dynamics = chain.dynamics(requestAll(chain.mechanism));
  BlockInverseDynamics<double> block(dynamics, 3);
  const std::vector<Motion> motions = chain.builder.motions(60);
  const auto expected =
      blockResults<double>(dynamics, motions, kLayouts[0], 1, chosenInstructionSet());
  for (int round = 0; round < 300; ++round) {
    const std::size_t samples = static_cast<std::size_t>(round * 7 % 61);
    const auto results =
        blockResults(block, {motions.begin(), motions.begin() + samples}, kLayouts[round % 2]);
    for (std::size_t n = 0; n < samples; ++n) {
      ASSERT_EQ(differences(results[n], expected[n]), "") << "round " << round;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
