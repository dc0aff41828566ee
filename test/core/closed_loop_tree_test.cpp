#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "named_loop_results.h"
#include "random_loops.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Residual of the loops' equations after solution, relative to the largest result: rounding of the
// solution, whose entries grow with the condition number.
constexpr double kPerCondition = 100 * 2.2e-16;
// Relative to magnitudes of all terms, the closures' wrenches among them. The residual of the
// loops' equations is rounding of these.
constexpr double kRounding = 1e-14;

constexpr int kCases = 300;

Wrench scaled(const Wrench& wrench) {
  return {1.001 * wrench.force, 1.001 * wrench.torque};
}

/// The tree of a mechanism with loops, as those see it that know of none.
class ClosedLoopTree : public testing::Test {
 protected:
  /// False when too few joints are actuated.
  bool next() {
    loops = random.next();
    names = {kGround};
    for (const Joint& joint : loops.mechanism.joints()) names.push_back(joint.name);
    try {
      results = std::make_unique<NamedLoopResults>(loops.mechanism, loops.scene, loops.motion);
    } catch (const SceneError&) {
      return false;
    }
    return true;
  }

  double scale() const {
    double largest = 1;
    for (const std::string& name : results->names()) {
      const Wrench& wrench = results->rootAxes(name);
      largest = std::max({largest, wrench.force.norm(), wrench.torque.norm()});
    }
    return largest;
  }

  RandomLoops random{71};
  Case loops = random.next();
  std::vector<std::string> names;  // of joints, and of ground
  std::unique_ptr<NamedLoopResults> results;
};

// Passive joints are not told that they are: their efforts come out as zero.
TEST_F(ClosedLoopTree, LagrangesEquationsFindTheSame) {
  int compared = 0;
  for (int i = 0; i < kCases; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    if (!next()) continue;
    const ClosedLoops& dynamics = results->dynamics();
    Request request;
    request.child_axes = request.root_axes = names;
    LagrangeDynamics<long double> lagrange(loops.mechanism, dynamics.tree(), request);
    lagrange.compute(loops.motion, dynamics.treeLoad());
    const double tolerance =
        kPerCondition * std::max(1.0, dynamics.determinacy().condition) * scale();
    for (Eigen::Index c = 0; c < dynamics.coordinates(); ++c) {
      EXPECT_NEAR(lagrange.effort()[c], dynamics.effort()[c], tolerance) << c;
      compared += !dynamics.actuated()[static_cast<std::size_t>(c)];
    }
    for (std::size_t n = 0; n < names.size(); ++n) {
      const Wrench &child = results->childAxes(names[n]), &root = results->rootAxes(names[n]);
      const auto expectNear = [&](const Wrench& found, const Wrench& expected) {
        EXPECT_LE((found.force - expected.force).norm(), tolerance) << names[n];
        EXPECT_LE((found.torque - expected.torque).norm(), tolerance) << names[n];
      };
      expectNear(lagrange.childAxes()[n], child);
      expectNear(lagrange.rootAxes()[n], root);
    }
  }
  EXPECT_GE(compared, 100);
}

// Velocities need not satisfy the loops: the power of what acts in closures is counted.
TEST_F(ClosedLoopTree, CertificatesHold) {
  int certified = 0, powers = 0;
  for (int i = 0; i < kCases; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    if (!next()) continue;
    const ClosedLoops& dynamics = results->dynamics();
    Certifier certifier(loops.mechanism, dynamics.tree());
    const Load load = dynamics.treeLoad();
    const Eigen::VectorXd effort = dynamics.effort().head(dynamics.coordinates());
    const Wrench& ground = results->childAxes(kGround);
    const Certificates found = certifier.check(loops.motion, load, effort, ground);
    EXPECT_LE(found.largest(), kRounding);
    ++certified;
    if (effort.isZero(0) || dynamics.tree().static_motion) continue;
    const Certificates wrong = certifier.check(loops.motion, load, 1.001 * effort, scaled(ground));
    powers += wrong.power > 1e-6;
    EXPECT_GT(wrong.largest(), kRounding);
  }
  EXPECT_GE(certified, 100);
  EXPECT_GE(powers, 50);
}

TEST_F(ClosedLoopTree, OwnWrenchesComeFirst) {
  while (!next() || loops.scene.applied_wrenches.empty() || loops.scene.springs.empty()) continue;
  const ClosedLoops& dynamics = results->dynamics();
  const std::size_t own = loops.scene.applied_wrenches.size();
  const std::size_t others = 2 * (loops.scene.springs.size() + loops.scene.closures.size());
  const Load load = dynamics.treeLoad();
  ASSERT_EQ(dynamics.tree().applied_wrenches.size(), own + others);
  ASSERT_EQ(load.wrenches.size(), own + others);
  for (std::size_t i = 0; i < own; ++i) {
    const AppliedWrench& given = loops.scene.applied_wrenches[i];
    EXPECT_EQ(dynamics.tree().applied_wrenches[i].link, given.link);
    EXPECT_EQ(dynamics.tree().applied_wrenches[i].force, given.force);
    EXPECT_EQ(load.wrenches[i].force, given.force);
    EXPECT_EQ(load.wrenches[i].torque, given.torque);
  }
  EXPECT_FALSE(needsClosedLoops(dynamics.tree()));
}

}  // namespace
}  // namespace virtual_work_dynamics
