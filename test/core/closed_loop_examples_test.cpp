#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "lagrange_multipliers_oracle.h"
#include "loop_examples.h"
#include "maximal_coordinates_oracle.h"
#include "named_loop_results.h"

namespace virtual_work_dynamics {
namespace {

// Largest difference between two independent routes through a mechanism of some twenty bodies,
// relative to the largest force or moment of the sample.
constexpr double kTwoRoutes = 1e-11;

struct Example {
  std::string name;
  std::function<Positions(long double)> positions;
  int redundant_constraints;
  int redundancy;
};

void PrintTo(const Example& example, std::ostream* out) {
  *out << example.name;
}

class ClosedLoopExamples : public testing::TestWithParam<Example> {
 protected:
  ClosedLoopExamples() : example_(GetParam().name) {}

  Motion motion(double t) const { return motionAt(example_.mechanism, GetParam().positions, t); }

  NamedLoopResults results(const Motion& motion) const {
    return {example_.mechanism, example_.scene, motion};
  }

  std::vector<double> times() const { return {0.1, 0.55, 0.9, 1.7}; }

  LoopExample example_;
};

double largest(const NamedLoopResults& results) {
  double largest = 0;
  for (const std::string& name : results.names()) {
    for (int i = 0; i < 6; ++i) {
      largest = std::max(largest, std::abs(component(results.rootAxes(name), i)));
    }
  }
  return largest;
}

void expectSame(const MaximalCoordinatesOracle::Reaction& expected, const Wrench& wrench,
                const Determined& determined, double tolerance, const std::string& what) {
  for (int i = 0; i < 6; ++i) {
    const std::string label = what + ", component " + std::to_string(i);
    EXPECT_EQ(determined[i], expected.determined[i]) << label;
    EXPECT_TRUE(std::isfinite(component(wrench, i))) << label;
    if (!expected.determined[i]) continue;
    EXPECT_NEAR(component(wrench, i), static_cast<double>(expected.wrench[i]), tolerance) << label;
  }
}

TEST_P(ClosedLoopExamples, AgreesWithMaximalCoordinates) {
  for (const double t : times()) {
    const Motion state = motion(t);
    const NamedLoopResults results = this->results(state);
    const MaximalCoordinatesOracle oracle(example_.mechanism, example_.scene, state);
    const double tolerance = kTwoRoutes * largest(results);
    for (const std::string& name : results.names()) {
      expectSame(oracle.rootAxes(name), results.rootAxes(name), results.rootAxesDetermined(name),
                 tolerance, name + ", root axes");
      expectSame(oracle.childAxes(name), results.childAxes(name), results.childAxesDetermined(name),
                 tolerance, name + ", child axes");
    }
    for (std::size_t i = 0; i < example_.mechanism.coordinates().size(); ++i) {
      const std::string& name = example_.mechanism.coordinateNames()[i];
      const auto effort = oracle.effort(static_cast<int>(i));
      EXPECT_NEAR(results.effort(name), static_cast<double>(effort.value), tolerance) << name;
      EXPECT_EQ(results.effortDetermined(name), effort.determined) << name;
    }
    EXPECT_EQ(results.dynamics().determinacy().redundancy, oracle.redundancy());
    // Results that are not determined are a solution nevertheless.
    EXPECT_LE(oracle.violationBy([&](const std::string& name) { return results.rootAxes(name); }),
              kTwoRoutes);
  }
}

TEST_P(ClosedLoopExamples, AgreesWithLagrangesEquationsWithMultipliers) {
  for (const double t : times()) {
    const Motion state = motion(t);
    const NamedLoopResults results = this->results(state);
    const LagrangeMultipliersOracle oracle(example_.mechanism, example_.scene, state);
    const double tolerance = kTwoRoutes * largest(results);
    for (const std::string& name : results.names()) {
      const Wrench expected = oracle.rootAxes(name);
      for (int i = 0; i < 6; ++i) {
        if (!results.rootAxesDetermined(name)[static_cast<std::size_t>(i)]) continue;
        EXPECT_NEAR(component(results.rootAxes(name), i), component(expected, i), tolerance)
            << name << ", component " << i;
      }
    }
    for (Eigen::Index i = 0; i < state.q.size(); ++i) {
      EXPECT_NEAR(results.dynamics().effort()[i], oracle.effort(i), tolerance);
    }
  }
}

TEST_P(ClosedLoopExamples, CountsRedundantConstraints) {
  for (const double t : times()) {
    const NamedLoopResults results = this->results(motion(t));
    const Determinacy& found = results.dynamics().determinacy();
    EXPECT_EQ(found.redundant_constraints, GetParam().redundant_constraints);
    EXPECT_EQ(found.redundancy, GetParam().redundancy);
    EXPECT_EQ(found.free_motions, 0);
    // Singular values that count and those that are rounding errors lie far apart.
    EXPECT_GE(found.gap, 1e8);
  }
}

// Newton's method ends at 1e-14 of a size of some 0.1 to 1 m; what angles and accelerations make of
// it is larger by the condition of the mechanism, below 1e2 in these motions.
constexpr double kCompletion = 1e-11;

TEST_P(ClosedLoopExamples, CompletesTheMotionOfTheActuatedJoints) {
  NamedLoopResults results = this->results(motion(0.1));
  ClosedLoops dynamics(example_.mechanism, example_.scene);
  for (const double t : times()) {
    const Motion expected = motion(t);
    Motion completed = motion(t - 0.01);  // the passive ones as of the sample before
    for (Eigen::Index i = 0; i < expected.q.size(); ++i) {
      if (!dynamics.actuated()[static_cast<std::size_t>(i)]) {
        completed.qd[i] = completed.qdd[i] = 1e3;  // whatever was there before
        continue;
      }
      completed.q[i] = expected.q[i];
      completed.qd[i] = expected.qd[i];
      completed.qdd[i] = expected.qdd[i];
    }
    ASSERT_TRUE(dynamics.complete(completed));
    const double scale = std::max(1.0, expected.qdd.cwiseAbs().maxCoeff());
    EXPECT_LE((completed.q - expected.q).cwiseAbs().maxCoeff(), kCompletion);
    EXPECT_LE((completed.qd - expected.qd).cwiseAbs().maxCoeff(), kCompletion * scale);
    EXPECT_LE((completed.qdd - expected.qdd).cwiseAbs().maxCoeff(), kCompletion * scale);
  }
}

TEST_P(ClosedLoopExamples, MeasuresHowFarAMotionViolatesTheLoops) {
  const Motion exact = motion(0.55);
  const double scale = std::max(1.0, exact.qdd.cwiseAbs().maxCoeff());
  const NamedLoopResults closed = results(exact);
  for (const ClosureResidual& residual : closed.dynamics().residuals()) {
    EXPECT_LE(residual.position, kCompletion);
    EXPECT_LE(residual.velocity, kCompletion * scale);
    EXPECT_LE(residual.acceleration, kCompletion * scale);
  }
}

// Count by Wojtyra's criterion, M. Wojtyra, "Joint reaction forces in multibody systems with
// redundant constraints", Multibody System Dynamics 14 (2005): the defect of the rank of the
// constraint matrix. A planar loop of revolute joints in space has three, one for the force out of
// the plane and two for the moments in it.
INSTANTIATE_TEST_SUITE_P(All, ClosedLoopExamples,
                         testing::Values(Example{"four_bar", fourBarAt, 3, 3},
                                         Example{"slider_crank", sliderCrankAt, 3, 3},
                                         Example{"andrews_squeezer", andrewsAt, 9, 9},
                                         Example{"planar_3rrr", planar3rrrAt, 6, 6},
                                         Example{"stewart_gough", stewartGoughAt, 0, 0},
                                         Example{"spatial_parallelogram", parallelogramAt, 1, 1}),
                         [](const auto& param_info) { return param_info.param.name; });

}  // namespace
}  // namespace virtual_work_dynamics
