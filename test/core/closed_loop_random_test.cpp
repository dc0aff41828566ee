#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "maximal_coordinates_oracle.h"
#include "named_loop_results.h"
#include "random_loops.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest component of the sample. Loops at random positions amplify rounding
// errors by their condition number, which the results report; a hundred eps for each.
constexpr double kPerCondition = 100 * 2.2e-16;

double scaleOf(const NamedLoopResults& results) {
  double scale = 1;
  for (const std::string& name : results.names()) {
    for (int i = 0; i < 6; ++i) {
      scale = std::max(scale, std::abs(component(results.rootAxes(name), i)));
    }
  }
  return std::max(scale, results.dynamics().effort().cwiseAbs().maxCoeff());
}

class RandomLoopsTest : public testing::Test {
 protected:
  // What has freedoms left is refused by both.
  void checkAll(RandomLoops random) {
    int solved = 0, too_few = 0;
    for (int i = 0; i < 400; ++i) {
      SCOPED_TRACE("case " + std::to_string(i));
      const Case loops = random.next();
      const MaximalCoordinatesOracle oracle(loops.mechanism, loops.scene, loops.motion);
      if (oracle.freeMotions() > 0) {
        ++too_few;
        EXPECT_THROW(NamedLoopResults(loops.mechanism, loops.scene, loops.motion), SceneError);
        continue;
      }
      ++solved;
      check(loops, oracle);
    }
    EXPECT_GE(solved, 100);
    EXPECT_GE(too_few, 20);
    EXPECT_GE(compared_, 1000);
  }

 private:
  void check(const Case& loops, const MaximalCoordinatesOracle& oracle) {
    const NamedLoopResults results(loops.mechanism, loops.scene, loops.motion);
    const ClosedLoops& dynamics = results.dynamics();
    const double tolerance =
        kPerCondition * std::max(1.0, dynamics.determinacy().condition) * scaleOf(results);
    EXPECT_EQ(dynamics.determinacy().redundancy, oracle.redundancy());
    EXPECT_EQ(dynamics.determinacy().free_motions, 0);
    for (const std::string& name : results.names()) {
      expectSame(oracle.rootAxes(name), results.rootAxes(name), results.rootAxesDetermined(name),
                 tolerance, name);
      expectSame(oracle.childAxes(name), results.childAxes(name), results.childAxesDetermined(name),
                 tolerance, name);
    }
    Eigen::Index i = 0;
    for (; i < dynamics.coordinates(); ++i) {
      expectSame(oracle.effort(static_cast<int>(i)), i, dynamics, tolerance);
    }
    for (const std::string& name : dynamics.actuatedClosures()) {
      expectSame(oracle.closureEffort(name), i++, dynamics, tolerance);
    }
    EXPECT_LE(oracle.violationBy([&](const std::string& name) { return results.rootAxes(name); }),
              tolerance);
  }

  void expectSame(const MaximalCoordinatesOracle::Reaction& expected, const Wrench& wrench,
                  const Determined& determined, double tolerance, const std::string& name) {
    EXPECT_EQ(determined, expected.determined) << name;
    for (int i = 0; i < 6; ++i) {
      EXPECT_TRUE(std::isfinite(component(wrench, i))) << name;
      if (!expected.determined[static_cast<std::size_t>(i)]) continue;
      ++compared_;
      EXPECT_NEAR(component(wrench, i), static_cast<double>(expected.wrench[i]), tolerance)
          << name << ", component " << i;
    }
  }

  static void expectSame(const MaximalCoordinatesOracle::Effort& expected, Eigen::Index i,
                         const ClosedLoops& dynamics, double tolerance) {
    EXPECT_EQ(dynamics.effortDetermined()[static_cast<std::size_t>(i)], expected.determined)
        << "effort " << i;
    if (!expected.determined) return;
    EXPECT_NEAR(dynamics.effort()[i], static_cast<double>(expected.value), tolerance)
        << "effort " << i;
  }

  int compared_ = 0;
};

TEST_F(RandomLoopsTest, AgreeWithMaximalCoordinates) {
  checkAll(RandomLoops(32));
}

// Wheels, blades and points on planes, and cylinders, mixed with joints of all types.
TEST_F(RandomLoopsTest, WithContactsAndCylindersAgreeWithMaximalCoordinates) {
  checkAll(RandomLoops(17, true));
}

}  // namespace
}  // namespace virtual_work_dynamics
