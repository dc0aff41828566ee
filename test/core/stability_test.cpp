#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plain_results.h"
#include "stability/exact_results.h"
#include "stability/sweeps.h"

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

Errors errorsOf(const StabilityCase& stability_case) {
  const Mechanism& mechanism = stability_case.mechanism;
  const Scene& scene = stability_case.scene;
  const InverseDynamics dynamics(mechanism, scene, requestEveryJoint(mechanism));
  ErrorBound bound(mechanism, scene);
  RandomNumbers random(kSeed);
  Errors errors;
  for (int n = 0; n < kStates; ++n) {
    const Motion motion = stability_case.motion(random);
    bound.compute(motion);
    const ExactResults exact(mechanism, scene, motion, bound);
    bound.compute(motion, kDouble.least);
    errors.include(exact.errorsOf(resultsOf(dynamics, motion), kDouble, bound));
  }
  return errors;
}

TEST(Stability, ErrorsStayWithinTheirBoundsAtTheEndsOfEveryScene) {
  for (const Sweep& sweep : allSweeps()) {
    for (const double value : {sweep.values.front(), sweep.values.back()}) {
      const Errors errors = errorsOf(sweep.make(value));
      EXPECT_LE(errors.over_bound, 1)
          << sweep.scene << ", " << sweep.parameter << ": " << value << "; " << errors.worst;
    }
  }
}

// The judge itself: what it must not let pass.
class StabilityJudge : public ::testing::Test {
 protected:
  StabilityJudge() : case_(allSweeps().front().make(1)), bound_(case_.mechanism, case_.scene) {
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

#endif

}  // namespace
}  // namespace virtual_work_dynamics
