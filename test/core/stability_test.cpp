#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "plain_results.h"
#include "stability/exact_results.h"
#include "stability/loop_judge.h"
#include "stability/sweeps.h"
#include "stability/worst_certificates.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

#ifndef VWD_HAS_REAL113

TEST(Stability, IsMeasuredIn113Bits) {
  GTEST_SKIP() << "this compiler has no number of 113 bits";
}

#else

// A few states at both ends of every scene; scripts/stability.sh has the others, and the other ways
// to compute.
constexpr int kStates = 3;
constexpr std::uint32_t kSeed = 9;
const PrecisionLimits kDouble{std::numeric_limits<double>::epsilon(),
                              std::numeric_limits<double>::min(),
                              std::numeric_limits<double>::max()};

StateResults resultsOf(const InverseDynamics& dynamics, const Motion& motion) {
  const PlainResults<double> results = singleResults(dynamics, motion);
  return {{results.effort.begin(), results.effort.end()},
          {results.child_axes.begin(), results.child_axes.end()},
          {results.root_axes.begin(), results.root_axes.end()}};
}

struct Judged {
  Errors errors;
  WorstCertificates certificates;
};

Judged judge(const StabilityCase& stability_case) {
  const Mechanism& mechanism = stability_case.mechanism;
  const Scene& scene = stability_case.scene;
  const InverseDynamics dynamics(mechanism, scene, requestEveryJoint(mechanism));
  ErrorBound bound(mechanism, scene);
  RandomNumbers random(kSeed);
  Errors errors;
  std::vector<Motion> motions;
  std::vector<StateResults> results;
  for (int n = 0; n < kStates; ++n) {
    motions.push_back(stability_case.motion(random));
    const Motion& motion = motions.back();
    bound.compute(motion);
    const ExactResults exact(mechanism, scene, motion, bound);
    bound.compute(motion, kDouble.least);
    results.push_back(resultsOf(dynamics, motion));
    errors.include(exact.errorsOf(results.back(), kDouble, bound));
  }
  return {errors, certify(mechanism, scene, motions, results)};
}

TEST(Stability, ErrorsAndCertificatesStayWithinTheirBoundsAtTheEndsOfEveryScene) {
  for (const Sweep& sweep : treeSweeps()) {
    for (const double value : {sweep.values.front(), sweep.values.back()}) {
      const Judged judged = judge(sweep.make(value));
      const std::string where = sweep.scene + ", " + sweep.parameter + ": " + std::to_string(value);
      EXPECT_LE(judged.errors.over_bound, 1) << where << "; " << judged.errors.worst;
      EXPECT_LE(judged.certificates.overLimit(), 1)
          << where << "; " << judged.certificates.worstName();
    }
  }
}

// The exact equations of all joints take the cube of their number.
constexpr std::size_t kMostJoints = 25;

LoopVerdict judgeLoops(const StabilityCase& stability_case) {
  LoopJudge judge(stability_case.mechanism, stability_case.scene);
  RandomNumbers random(kSeed);
  LoopVerdict verdict;
  for (int n = 0; n < kStates; ++n) {
    verdict.include(judge.judge(stability_case.motion(random), random));
  }
  return verdict;
}

LoopVerdict judgeLoops(const std::string& scene, double value) {
  for (const Sweep& sweep : loopSweeps()) {
    if (sweep.scene == scene) return judgeLoops(sweep.make(value));
  }
  throw std::runtime_error("there is no scene " + scene);
}

TEST(Stability, ClosedLoopsStayWithinTheirBoundsAndAgreeInCountsAndFlags) {
  for (const Sweep& sweep : loopSweeps()) {
    const std::vector<double>& values = sweep.values;
    for (const double value : {values.front(), values[values.size() / 2], values.back()}) {
      const StabilityCase stability_case = sweep.make(value);
      if (stability_case.mechanism.joints().size() > kMostJoints) continue;
      const LoopVerdict verdict = judgeLoops(stability_case);
      SCOPED_TRACE(sweep.scene + ", " + sweep.parameter + ": " + std::to_string(value));
      EXPECT_LE(verdict.errors.over_bound, 1) << verdict.errors.worst;
      EXPECT_EQ(verdict.apart, 0) << verdict.worst_apart;
      EXPECT_LE(verdict.residual, 1);
      EXPECT_EQ(verdict.states, kStates);
    }
  }
}

// From determined with a large condition to singular, at about the rank's tolerance of 1e-10.
TEST(Stability, LoopsAreDeterminedUntilTheRankDrops) {
  for (const char* scene : {"loop_change_point", "loop_dead_centre", "loop_gimbals"}) {
    SCOPED_TRACE(scene);
    const LoopVerdict ordinary = judgeLoops(scene, 1e-2);
    const LoopVerdict near = judgeLoops(scene, 1e-8), singular = judgeLoops(scene, 1e-12);
    EXPECT_GT(near.condition, 1e4 * ordinary.condition);
    EXPECT_EQ(near.rank, ordinary.rank);
    EXPECT_EQ(near.redundancy, ordinary.redundancy);
    EXPECT_LE(near.open, ordinary.open);
    EXPECT_EQ(near.free_motions, 0);
    EXPECT_EQ(singular.rank, ordinary.rank - 1);
    EXPECT_EQ(singular.redundancy, ordinary.redundancy + 1);
    EXPECT_EQ(singular.free_motions, 1);
    EXPECT_GT(singular.open, ordinary.open);
    EXPECT_EQ(ordinary.completed, kStates);
    EXPECT_EQ(singular.completed, 0);
  }
}

// Always three redundant constraints; of parallel axes, forces in the plane are determined besides.
TEST(Stability, LoopsOfNearlyParallelAxesCountAsParallel) {
  const LoopVerdict spherical = judgeLoops("loop_parallel_axes", 1e-4);
  const LoopVerdict parallel = judgeLoops("loop_parallel_axes", 1e-12);
  EXPECT_EQ(spherical.redundant_constraints, 3);
  EXPECT_EQ(parallel.redundant_constraints, 3);
  EXPECT_LT(parallel.open, spherical.open);
  EXPECT_LT(parallel.condition, 10);
}

// It is singular in every position, and so refused before anything is computed.
TEST(Stability, ALinkSmallerThanTheRankToleranceHoldsNothing) {
  try {
    judgeLoops("loop_tiny_link", 1e-11);
    FAIL() << "it is not refused";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("nothing holds the motion of 'B', 'C'"),
              std::string::npos)
        << error.what();
  }
}

TEST(Stability, EachFourBarOfALadderHasThreeRedundantConstraints) {
  EXPECT_EQ(judgeLoops("loop_ladder", 5).redundant_constraints, 15);
}

// The judge of loops: what it must not let pass.
class LoopStabilityJudge : public ::testing::Test {
 protected:
  LoopStabilityJudge() {
    RandomNumbers random(kSeed);
    motion_ = case_.motion(random);
    good_ = judge_.compute(motion_);
    found_ = judge_.determinacy();
  }

  LoopVerdict judged(const LoopComponents& components) const {
    return judge_.compare(motion_, components, found_);
  }

  const StabilityCase case_ = loopSweeps().front().make(0.1);
  LoopJudge judge_{case_.mechanism, case_.scene};
  Motion motion_;
  LoopComponents good_;
  Determinacy found_;
};

TEST_F(LoopStabilityJudge, FindsAnErrorOfEveryDeterminedNumber) {
  EXPECT_TRUE(judged(good_).good());
  int determined = 0;
  for (std::size_t i = 0; i < good_.size(); ++i) {
    LoopComponents wrong = good_;
    wrong[i].value += 1e-9;
    EXPECT_EQ(judged(wrong).errors.over_bound > 1, good_[i].determined) << i;
    determined += good_[i].determined;
  }
  EXPECT_GE(determined, 20);
}

TEST_F(LoopStabilityJudge, FindsAWrongFlagOfEveryNumber) {
  for (std::size_t i = 0; i < good_.size(); ++i) {
    LoopComponents wrong = good_;
    wrong[i].determined = !wrong[i].determined;
    EXPECT_EQ(judged(wrong).apart, 1) << i;
  }
}

TEST_F(LoopStabilityJudge, FindsEveryNumberThatDoesNotExist) {
  for (std::size_t i = 0; i < good_.size(); ++i) {
    LoopComponents wrong = good_;
    wrong[i].exists = false;
    EXPECT_EQ(judged(wrong).apart, 1) << i;
  }
}

TEST_F(LoopStabilityJudge, FindsWrongCounts) {
  ++found_.redundancy;
  EXPECT_EQ(judged(good_).apart, 1);
  --found_.redundancy;
  ++found_.free_motions;
  EXPECT_EQ(judged(good_).apart, 1);
}

TEST_F(LoopStabilityJudge, TakesWhatIsNotFiniteForAnInfiniteError) {
  for (std::size_t i = 0; i < good_.size(); ++i) {
    for (const double bad : {std::nan(""), HUGE_VAL}) {
      LoopComponents wrong = good_;
      wrong[i].value = bad;
      EXPECT_TRUE(std::isinf(judged(wrong).errors.over_bound)) << i;
    }
  }
}

TEST_F(LoopStabilityJudge, BelievesNoConditionThatIsTooLarge) {
  LoopComponents wrong = good_;
  wrong[0].value += 1e-6;
  found_.condition = 1e12;
  EXPECT_GT(judged(wrong).errors.over_bound, 1);
}

TEST_F(LoopStabilityJudge, KeepsTheWorstOfAllStates) {
  LoopVerdict all = judged(good_), worse = judged(good_);
  worse.rank = 1;
  worse.apart = 2;
  worse.residual = 3;
  worse.worst_apart = "flag";
  all.include(worse);
  all.include(judged(good_));
  EXPECT_EQ(all.rank, 1);
  EXPECT_EQ(all.apart, 2);
  EXPECT_EQ(all.residual, 3);
  EXPECT_EQ(all.worst_apart, "flag");
  EXPECT_EQ(all.states, 3);
  EXPECT_FALSE(all.good());
}

// The judge of trees: what it must not let pass.
class StabilityJudge : public ::testing::Test {
 protected:
  StabilityJudge() : case_(treeSweeps().front().make(1)), bound_(case_.mechanism, case_.scene) {
    RandomNumbers random(kSeed);
    motion_ = case_.motion(random);
    bound_.compute(motion_);
    good_ = resultsOf(
        InverseDynamics(case_.mechanism, case_.scene, requestEveryJoint(case_.mechanism)), motion_);
  }

  Errors judged(const StateResults& results) const {
    return ExactResults(case_.mechanism, case_.scene, motion_, bound_)
        .errorsOf(results, kDouble, bound_);
  }

  WorstCertificates certified(const StateResults& results) const {
    return certify(case_.mechanism, case_.scene, {motion_}, {results});
  }

  StabilityCase case_;
  ErrorBound bound_;
  Motion motion_;
  StateResults good_;
};

TEST_F(StabilityJudge, FindsAnErrorOfOneNumberInEveryKindOfResult) {
  EXPECT_LE(judged(good_).over_bound, 1);
  const std::size_t last = good_.child_axes.size() - 1;
  for (auto numbers :
       {&StateResults::efforts, &StateResults::child_axes, &StateResults::root_axes}) {
    for (const std::size_t place : {std::size_t(0), std::min(last, (good_.*numbers).size() - 1)}) {
      StateResults wrong = good_;
      (wrong.*numbers)[place] += 1e-9L;
      EXPECT_GT(judged(wrong).over_bound, 1) << place;
    }
  }
}

TEST_F(StabilityJudge, CountsNoJointsBeforeTheOneInTheNarrowerBound) {
  const std::size_t joints = case_.mechanism.joints().size();  // a chain's
  StateResults wrong = good_;
  wrong.efforts.front() += 1e-9L;
  EXPECT_GT(judged(wrong).over_bound, 1);
  EXPECT_DOUBLE_EQ(judged(wrong).over_subtree_bound, judged(wrong).over_bound);
  wrong = good_;
  wrong.efforts.back() += 1e-9L;
  EXPECT_GT(judged(wrong).over_bound, 1);
  EXPECT_DOUBLE_EQ(judged(wrong).over_subtree_bound,
                   static_cast<double>(joints) * judged(wrong).over_bound);
}

TEST_F(StabilityJudge, TakesWhatIsNotFiniteForAnInfiniteError) {
  for (const long double bad : {std::numeric_limits<long double>::quiet_NaN(),
                                std::numeric_limits<long double>::infinity()}) {
    StateResults wrong = good_;
    wrong.root_axes[4] = bad;
    EXPECT_TRUE(std::isinf(judged(wrong).over_bound));
    EXPECT_TRUE(std::isinf(judged(wrong).relative));
  }
}

TEST_F(StabilityJudge, LeavesOutWhatIsBeyondThePrecision) {
  StateResults overflowed = good_;
  for (long double& number : overflowed.efforts) number = INFINITY;
  const ExactResults exact(case_.mechanism, case_.scene, motion_, bound_);
  const PrecisionLimits narrow{kDouble.eps, kDouble.least, 1e-30L};
  EXPECT_EQ(exact.errorsOf(overflowed, narrow, bound_).over_bound, 0);
}

TEST_F(StabilityJudge, CertifiesOneNumberOfEveryKind) {
  EXPECT_LE(certified(good_).overLimit(), 1);
  const auto name_of = [&](const StateResults& wrong) {
    const WorstCertificates certificates = certified(wrong);
    return certificates.overLimit() > 1 ? certificates.worstName() : "within its limit";
  };
  StateResults wrong = good_;
  wrong.efforts[0] += 1e-9L;
  EXPECT_EQ(name_of(wrong), "power");
  wrong = good_;
  wrong.child_axes[2] += 1e-9L;
  EXPECT_EQ(name_of(wrong), "ground's force");
  wrong = good_;
  wrong.child_axes[3] += 1e-9L;
  EXPECT_EQ(name_of(wrong), "ground's moment");
}

TEST_F(StabilityJudge, LeavesStatesThatAreNotFiniteToTheBounds) {
  StateResults wrong = good_;
  wrong.efforts[0] = NAN;
  EXPECT_EQ(certified(wrong).worst.largest(), 0);
}

TEST_F(StabilityJudge, NeverLosesACertificateThatIsNoNumber) {
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    WorstCertificates certificates = certified(good_);
    certificates.include(Certificates{0, bad, 0});
    certificates.include(certified(good_));
    EXPECT_TRUE(std::isinf(certificates.overLimit())) << bad;
  }
}

#endif

}  // namespace
}  // namespace virtual_work_dynamics
