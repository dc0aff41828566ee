#include "virtual_work_dynamics/instruction_set.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "robot_builder.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr InstructionSet kAll[] = {InstructionSet::kBaseline, InstructionSet::kAvx2,
                                   InstructionSet::kAvx512};

// The variable is what it was after each test.
class InstructionSets : public ::testing::Test {
 protected:
  InstructionSets() {
    const char* const value = std::getenv(kInstructionSetVariable);
    was_set_ = value;
    if (value) value_ = value;
    ::unsetenv(kInstructionSetVariable);
  }
  ~InstructionSets() override {
    if (was_set_) {
      ::setenv(kInstructionSetVariable, value_.c_str(), 1);
    } else {
      ::unsetenv(kInstructionSetVariable);
    }
  }

  static void set(const std::string& value) {
    ASSERT_EQ(::setenv(kInstructionSetVariable, value.c_str(), 1), 0);
  }

  static std::string refusal() {
    try {
      chosenInstructionSet();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

 private:
  bool was_set_;
  std::string value_;
};

TEST_F(InstructionSets, HaveTheNamesOfTheVariable) {
  EXPECT_EQ(toString(InstructionSet::kBaseline), "baseline");
  EXPECT_EQ(toString(InstructionSet::kAvx2), "avx2");
  EXPECT_EQ(toString(InstructionSet::kAvx512), "avx512");
  EXPECT_STREQ(kInstructionSetVariable, "VIRTUAL_WORK_DYNAMICS_INSTRUCTION_SET");
}

TEST_F(InstructionSets, BaselineIsEverywhere) {
  EXPECT_TRUE(isSupported(InstructionSet::kBaseline));
}

#if defined(__x86_64__)
TEST_F(InstructionSets, AreThoseOfTheMachine) {
  EXPECT_EQ(isSupported(InstructionSet::kAvx2),
            __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"));
  EXPECT_EQ(isSupported(InstructionSet::kAvx512), isSupported(InstructionSet::kAvx2) &&
                                                      __builtin_cpu_supports("avx512f") &&
                                                      __builtin_cpu_supports("avx512dq"));
}
#endif

TEST_F(InstructionSets, TheBestIsChosen) {
  InstructionSet best = InstructionSet::kBaseline;
  for (const InstructionSet candidate : kAll) {
    if (isSupported(candidate)) best = candidate;
  }
  EXPECT_EQ(chosenInstructionSet(), best);
  set("");  // an empty variable is none
  EXPECT_EQ(chosenInstructionSet(), best);
}

TEST_F(InstructionSets, TheVariableOverrides) {
  const Mechanism mechanism = chainOf(2).build();
  for (const InstructionSet wanted : kAll) {
    set(toString(wanted));
    if (isSupported(wanted)) {
      EXPECT_EQ(chosenInstructionSet(), wanted);
      const InverseDynamics dynamics(mechanism, Scene(), Request());
      EXPECT_EQ(BlockInverseDynamics<double>(dynamics).instructionSet(), wanted);
      EXPECT_EQ(BlockInverseDynamics<float>(dynamics).instructionSet(), wanted);
    } else {
      EXPECT_EQ(refusal(), std::string(kInstructionSetVariable) +
                               ": this machine or build has no " + toString(wanted));
      EXPECT_THROW(InverseDynamics(mechanism, Scene(), Request()), Error);
    }
  }
}

TEST_F(InstructionSets, OtherValuesAreRefused) {
  for (const std::string value : {"avx", "AVX2", " baseline", "avx512f", "sse2"}) {
    set(value);
    EXPECT_EQ(refusal(), std::string(kInstructionSetVariable) + ": '" + value +
                             "' is not one of baseline, avx2, avx512");
  }
}

// The plan of each is computed with its own instructions: those without fused multiply-add round
// otherwise.
TEST_F(InstructionSets, ServeSingleSamples) {
  if (!isSupported(InstructionSet::kAvx2)) GTEST_SKIP() << "this machine has the baseline only";
  RobotBuilder chain = chainOf(10);
  const Mechanism mechanism = chain.build();
  const Motion motion = chain.motion();
  const InverseDynamics baseline(mechanism, Scene(), Request(), InstructionSet::kBaseline);
  const InverseDynamics fused(mechanism, Scene(), Request(), InstructionSet::kAvx2);
  Workspace one = baseline.makeWorkspace(), other = fused.makeWorkspace();
  baseline.compute(motion, one);
  fused.compute(motion, other);
  EXPECT_NE(one.effort(), other.effort());
}

TEST_F(InstructionSets, UnsupportedOnesAreRefused) {
  const Mechanism mechanism = chainOf(2).build();
  const InverseDynamics dynamics(mechanism, Scene(), Request());
  const auto expectRefused = [&](InstructionSet unsupported) {
    EXPECT_FALSE(isSupported(unsupported));
    const std::string message =
        "this machine or build has no " + toString(unsupported) + " instructions";
    try {
      const InverseDynamics refused(mechanism, Scene(), Request(), unsupported);
      FAIL() << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), message);
    }
    EXPECT_THROW(BlockInverseDynamics<double>(dynamics, 1, unsupported), Error);
    EXPECT_THROW(BlockInverseDynamics<float>(dynamics, 1, unsupported), Error);
  };
  expectRefused(static_cast<InstructionSet>(77));  // whatever machine this is
  for (const InstructionSet candidate : kAll) {
    if (!isSupported(candidate)) expectRefused(candidate);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
