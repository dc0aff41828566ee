#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "dynamics/effort_groups.h"
#include "four_bar.h"
#include "loop_examples.h"
#include "newton_euler_oracle.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using MatrixXl = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double kTolerance = 1e-12;

// Two bars that hang on each other, with axes at an angle.
const char kPendulum[] = R"(<robot name="pendulum">
  <link name="base"/>
  <joint name="shoulder" type="continuous">
    <parent link="base"/><child link="upper"/>
    <origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 -0.1"/><axis xyz="0 1 0"/>
  </joint>
  <link name="upper"><inertial>
    <origin xyz="0.2 0.01 -0.02"/><mass value="1.5"/>
    <inertia ixx="0.01" iyy="0.03" izz="0.035" ixy="0.001" ixz="0.002" iyz="-0.001"/>
  </inertial></link>
  <joint name="elbow" type="continuous">
    <parent link="upper"/><child link="lower"/>
    <origin xyz="0.5 0 0" rpy="0.4 0 0.2"/><axis xyz="0 1 0"/>
  </joint>
  <link name="lower"><inertial>
    <origin xyz="0.15 -0.03 0.04"/><mass value="0.8"/>
    <inertia ixx="0.006" iyy="0.02" izz="0.021" ixy="0" ixz="0.001" iyz="0.0005"/>
  </inertial></link>
</robot>)";

VectorXl oracleEfforts(const Mechanism& mechanism, const Scene& scene, const Motion& motion) {
  const std::vector<long double> efforts = NewtonEulerOracle(mechanism, scene, motion).efforts();
  return Eigen::Map<const VectorXl>(efforts.data(), static_cast<Eigen::Index>(efforts.size()));
}

// The accelerations of a mechanism that nothing drives: M qdd = -h, where column i of M and h are
// efforts of Newton and Euler's equations.
Motion freeFlight(const Mechanism& mechanism, const Scene& scene, Motion motion) {
  const Eigen::Index n = motion.q.size();
  motion.qdd.setZero();
  const VectorXl h = oracleEfforts(mechanism, scene, motion);
  MatrixXl M(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Motion accelerated = motion;
    accelerated.qdd[i] = 1;
    M.col(i) = oracleEfforts(mechanism, scene, accelerated) - h;
  }
  motion.qdd = M.ldlt().solve(-h).cast<double>();
  return motion;
}

Scene freeScene() {
  Scene scene;
  scene.actuated.emplace();
  scene.free_motion = true;
  return scene;
}

TEST(FreeMotion, ResidualOfAFreePendulumVanishes) {
  const Mechanism mechanism = readUrdf(kPendulum);
  const Scene scene = freeScene();
  const Dynamics dynamics(mechanism, scene, Request{});
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  EXPECT_EQ(dynamics.effortNames(),
            (std::vector<std::string>{"residual.motion.shoulder", "residual.motion.elbow"}));
  for (int sample = 0; sample < 50; ++sample) {
    Motion motion(2);
    motion.q << 0.3 * sample, 1.1 - 0.7 * sample;
    motion.qd << std::sin(0.9 * sample), 3 * std::cos(1.3 * sample);
    motion = freeFlight(mechanism, Scene{}, motion);
    dynamics.compute(motion, workspace);
    const double residual = workspace.results().effort.cwiseAbs().maxCoeff();
    EXPECT_LE(residual, kTolerance * 20) << "of efforts up to 20 N m, at " << sample;
    // One that is pushed is seen.
    motion.qdd[1] += 1e-6;
    dynamics.compute(motion, workspace);
    EXPECT_GE(workspace.results().effort.cwiseAbs().maxCoeff(), 1e-9);
  }
}

// Nothing drives the linkage; the work of the residual at any joint is that of the motor at the
// crank in the closed form.
TEST(FreeMotion, ResidualOfALinkageDoesTheWorkOfItsMotor) {
  const FourBar linkage;
  for (const char pivot : {'A', 'B', 'C', 'D'}) {
    const FourBar::Cut cut = linkage.cut(pivot);
    Scene scene = cut.scene;
    scene.actuated.emplace();
    scene.free_motion = true;
    ClosedLoops loops(cut.mechanism, scene);
    int chosen = -1;
    for (int i = 0; i < 3; ++i) {
      if (!loops.residual()[static_cast<std::size_t>(i)]) continue;
      EXPECT_EQ(chosen, -1) << "one degree of freedom, pivot " << pivot;
      chosen = i;
    }
    ASSERT_GE(chosen, 0);
    for (int sample = 0; sample < 20; ++sample) {
      const FourBar::Turnings turnings = linkage.turnings(0.3L * sample, 1.7L, -2.1L);
      const Motion motion = cut.motion(turnings);
      loops.compute(motion);
      const auto power = static_cast<double>(linkage.freeBodies(turnings).torque * 1.7L);
      EXPECT_NEAR(loops.effort()[chosen] * motion.qd[chosen], power, kTolerance * 10);
      for (int i = 0; i < 3; ++i) {
        if (i != chosen) {
          EXPECT_EQ(loops.effort()[i], 0);
        }
      }
    }
  }
}

// The work of residuals and actuators together does not depend on how many actuators there are.
TEST(FreeMotion, ResidualsOfManyFreedomsDoTheWorkOfTheirMotors) {
  struct Case {
    std::string name;
    Positions (*positions)(long double);
  };
  for (const Case& of :
       {Case{"planar_3rrr", planar3rrrAt}, Case{"stewart_gough", stewartGoughAt}}) {
    SCOPED_TRACE(of.name);
    const LoopExample example(of.name);
    const std::size_t freedoms = example.scene.actuated->size();
    const Motion motion = motionAt(example.mechanism, of.positions, 0.7L);
    ClosedLoops driven(example.mechanism, example.scene);
    driven.compute(motion);
    const double power = driven.effort().dot(motion.qd);
    const double size = driven.effort().cwiseAbs().dot(motion.qd.cwiseAbs());
    for (std::size_t actuators = 0; actuators <= freedoms; ++actuators) {
      Scene scene = example.scene;
      scene.actuated->resize(actuators);
      scene.free_motion = true;
      ClosedLoops loops(example.mechanism, scene);
      const std::vector<bool>& residual = loops.residual();
      EXPECT_EQ(std::count(residual.begin(), residual.end(), true),
                static_cast<std::ptrdiff_t>(freedoms - actuators));
      loops.compute(motion);
      EXPECT_NEAR(loops.effort().dot(motion.qd), power, kTolerance * 10 * size);
    }
  }
}

// What motions give comes first among the coordinates that may be chosen.
TEST(FreeMotion, ResidualStandsAtWhatMotionsGive) {
  const FourBar linkage;
  const FourBar::Cut cut = linkage.cut('C');
  Scene scene = cut.scene;
  scene.actuated.emplace();
  scene.free_motion = true;
  for (const std::string given : {"A", "B", "D"}) {
    scene.given = std::vector<std::string>{given};
    const Dynamics dynamics(cut.mechanism, scene, Request{});
    const auto index = static_cast<std::size_t>(cut.mechanism.jointIndex(given));
    EXPECT_EQ(dynamics.effortNames()[index], "residual.motion." + given);
    EXPECT_EQ(dynamics.given().coordinates[index], true);
  }
}

// With a part of the actuators the residual is the effort of those that are missing.
TEST(FreeMotion, ResidualIsWhatMissingActuatorsWouldGive) {
  const Mechanism mechanism = readUrdf(kPendulum);
  Scene part = freeScene();
  part.actuated = std::vector<std::string>{"elbow"};
  Motion motion(2);
  motion.q << 0.4, -1.2;
  motion.qd << 1.5, -0.3;
  motion.qdd << -2, 5;
  const Dynamics dynamics(mechanism, part, Request{}), whole(mechanism, Scene{}, Request{});
  Dynamics::Workspace some = dynamics.makeWorkspace(), all = whole.makeWorkspace();
  dynamics.compute(motion, some);
  whole.compute(motion, all);
  EXPECT_EQ(dynamics.effortNames(),
            (std::vector<std::string>{"residual.motion.shoulder", "elbow"}));
  EXPECT_EQ(some.results().effort, all.results().effort);
}

void expectRefusal(const Mechanism& mechanism, const Scene& scene, const std::string& text) {
  try {
    const Dynamics dynamics(mechanism, scene, Request{});
    FAIL() << "not refused";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.what(), text);
  }
}

TEST(FreeMotion, IsRefusedUnlessAskedForAndWhereNothingIsFree) {
  const Mechanism mechanism = readUrdf(kPendulum);
  Scene scene = freeScene();
  scene.free_motion = false;
  expectRefusal(mechanism, scene,
                "actuated: too few for the degrees of freedom: nothing holds the motion of "
                "'shoulder', 'elbow' (free_motion: true reports what that motion demands)");
  scene = Scene{};
  scene.free_motion = true;
  expectRefusal(mechanism, scene,
                "free_motion: every joint is actuated unless 'actuated' says which are");
}

// Residuals are known by their place: a description may give a joint the same name.
TEST(FreeMotion, JointsMayHaveTheNamesOfResiduals) {
  std::string description = kPendulum;
  for (const std::string name : {"shoulder", "elbow"}) {
    const std::size_t at = description.find("joint name=\"" + name);
    description.insert(at + 12, "residual.motion.");
  }
  const Mechanism mechanism = readUrdf(description);
  Scene part = freeScene();
  part.actuated = std::vector<std::string>{"residual.motion.elbow"};
  const Dynamics dynamics(mechanism, part, Request{}), whole(mechanism, Scene{}, Request{});
  EXPECT_EQ(dynamics.effortNames(),
            (std::vector<std::string>{"residual.motion.residual.motion.shoulder",
                                      "residual.motion.elbow"}));
  EXPECT_EQ(dynamics.residuals(), (std::vector<bool>{true, false}));
  EXPECT_EQ(whole.residuals(), (std::vector<bool>{false, false}));
  const EffortGroups groups(dynamics);
  EXPECT_EQ(groups.residuals.size(), 1u);
  EXPECT_EQ(groups.actuated, std::vector<std::string>{"residual.motion.elbow"});
}

TEST(FreeMotion, LinkageWithEnoughActuatorsHasNoResidual) {
  const FourBar::Cut cut = FourBar().cut('D');
  Scene scene = cut.scene;
  scene.free_motion = true;
  const Dynamics with(cut.mechanism, scene, Request{}),
      without(cut.mechanism, cut.scene, Request{});
  EXPECT_EQ(with.effortNames(), without.effortNames());
}

}  // namespace
}  // namespace virtual_work_dynamics
