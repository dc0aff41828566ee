#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "plain_results.h"
#include "stability/exact_results.h"
#include "stability/sweeps.h"
#include "stability/worst_certificates.h"

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
  for (const Sweep& sweep : allSweeps()) {
    for (const double value : {sweep.values.front(), sweep.values.back()}) {
      const Judged judged = judge(sweep.make(value));
      const std::string where = sweep.scene + ", " + sweep.parameter + ": " + std::to_string(value);
      EXPECT_LE(judged.errors.over_bound, 1) << where << "; " << judged.errors.worst;
      EXPECT_LE(judged.certificates.overLimit(), 1)
          << where << "; " << judged.certificates.worstName();
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
