#include "virtual_work_dynamics/regressor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "loop_examples.h"
#include "newton_euler_oracle.h"
#include "random_cases.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// A few roundings of each term, among them those of the two masses whose difference is a first
// moment, relative to the sum of all terms' magnitudes.
constexpr double kRounding = 200 * std::numeric_limits<double>::epsilon();

MotionTable oneRow(const Motion& motion) {
  MotionTable table;
  table.times = {0};
  table.positions = motion.q.transpose();
  table.velocities = motion.qd.transpose();
  table.accelerations = motion.qdd.transpose();
  return table;
}

/// Columns of one sample.
struct Columns {
  std::vector<Parameter> parameters;
  Eigen::MatrixXd values;  // efforts x parameters

  Columns(const Mechanism& mechanism, const Scene& scene, std::vector<Parameter> wanted,
          const Motion& motion)
      : parameters(std::move(wanted)) {
    const MotionTable table = oneRow(motion);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      RegressorColumn column(mechanism, scene, parameters[i], 1);
      values.conservativeResize(column.efforts(), static_cast<Eigen::Index>(i) + 1);
      column.compute(table, 0, 1, values.col(static_cast<Eigen::Index>(i)).data());
    }
  }

  double of(ParameterKind kind, const std::string& name, Eigen::Index effort) const {
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].kind == kind && parameters[i].of == name) {
        return values(effort, static_cast<Eigen::Index>(i));
      }
    }
    ADD_FAILURE() << nameOf(kind) << " of " << name;
    return 0;
  }
  Eigen::VectorXd described() const {
    Eigen::VectorXd numbers(values.cols());
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      numbers[i] = parameters[static_cast<std::size_t>(i)].value;
    }
    return numbers;
  }
};

std::vector<Parameter> allParameters(const Mechanism& mechanism, const Scene& scene) {
  std::vector<Parameter> all = jointParameters(mechanism, scene);
  for (const std::string& link : bodies(mechanism)) {
    for (const Parameter& parameter : inertialParameters(mechanism, link)) all.push_back(parameter);
  }
  return all;
}

// What the terms of joints need, by their formula; `sizes` receives the sums of their magnitudes.
Eigen::VectorXd effortsOfTerms(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                               Eigen::VectorXd& sizes) {
  Eigen::VectorXd efforts = Eigen::VectorXd::Zero(motion.q.size());
  sizes = efforts;
  for (const JointTerms& terms : scene.joints) {
    const Joint& joint = mechanism.joint(mechanism.jointIndex(terms.joint));
    const double rate = scene.static_motion ? 0 : joint.multiplier * motion.qd[joint.coordinate];
    const double change = scene.static_motion ? 0 : joint.multiplier * motion.qdd[joint.coordinate];
    const double s = std::clamp(rate / terms.coulomb_velocity, -1.0, 1.0);
    for (const double part :
         {terms.damping.value_or(0) * rate, terms.coulomb.value_or(0) * s * (3 - s * s) / 2,
          terms.rotor_inertia * change, terms.offset}) {
      efforts[joint.coordinate] += joint.multiplier * part;
      sizes[joint.coordinate] += std::abs(joint.multiplier * part);
    }
  }
  return efforts;
}

// Trees with fixed, sliding and mimic joints, massless links, points and rods.
TEST(Regressor, TimesParametersIsNewtonEulersEffort) {
  RandomCases cases(16);
  int compared = 0;
  for (int n = 0; n < 60; ++n) {
    Case random = cases.next();
    Scene& scene = random.scene;
    scene.applied_wrenches.clear();
    scene.use_urdf_dynamics = false;
    for (JointTerms& terms : scene.joints) {
      terms.stiffness = 0;
      terms.coulomb_velocity = 2;  // so that many joints are slower
    }
    if (random.mechanism.coordinates().empty()) continue;
    const Columns columns(random.mechanism, scene, allParameters(random.mechanism, scene),
                          random.motion);
    Motion motion = random.motion;
    if (scene.static_motion) motion.qd.setZero(), motion.qdd.setZero();
    const NewtonEulerOracle oracle(random.mechanism, scene, motion);
    Eigen::VectorXd sizes;
    Eigen::VectorXd expected = effortsOfTerms(random.mechanism, scene, motion, sizes);
    const std::vector<long double> efforts = oracle.efforts();
    for (std::size_t i = 0; i < efforts.size(); ++i) {
      expected[static_cast<Eigen::Index>(i)] += static_cast<double>(efforts[i]);
    }
    const Eigen::VectorXd described = columns.described();
    const Eigen::VectorXd computed = columns.values * described;
    const double size = (columns.values.cwiseAbs() * described.cwiseAbs()).maxCoeff() +
                        columns.values.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < computed.size(); ++i) {
      EXPECT_LE(std::abs(computed[i] - expected[i]), kRounding * size) << n << ' ' << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, 150);
}

// Two links in a vertical plane, turning about z, gravity along -y.
TEST(Regressor, TwoLinkArmHasTheColumnsOfTheClosedForm) {
  constexpr double l = 0.7, g = 9.81;
  RobotBuilder builder(1);
  builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
  builder.add(JointType::kRevolute, 1, Vector3l::UnitZ(), Matrix3l::Identity(),
              Vector3l(0.7L, 0, 0));
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.gravity << 0, -g, 0;
  Motion motion(2);
  motion.q << 0.4, -1.3;
  motion.qd << 1.7, 0.6;
  motion.qdd << -3, 5;
  const double c1 = std::cos(0.4), s1 = std::sin(0.4), c2 = std::cos(-1.3), s2 = std::sin(-1.3);
  const double c12 = std::cos(-0.9), s12 = std::sin(-0.9);
  const double a = 2 * motion.qdd[0] + motion.qdd[1], both = motion.qdd.sum();
  const double w = 2 * motion.qd[0] * motion.qd[1] + motion.qd[1] * motion.qd[1];
  const double w1 = motion.qd[0] * motion.qd[0];
  using Kind = ParameterKind;
  struct Entry {
    Kind kind;
    const char* link;
    double first, second;  // effort
  };
  const Entry kEntries[] = {{Kind::kMass, "link_1", 0, 0},
                            {Kind::kFirstMomentX, "link_1", g * c1, 0},
                            {Kind::kFirstMomentY, "link_1", -g * s1, 0},
                            {Kind::kFirstMomentZ, "link_1", 0, 0},
                            {Kind::kInertiaZZ, "link_1", motion.qdd[0], 0},
                            {Kind::kMass, "link_2", l * l * motion.qdd[0] + g * l * c1, 0},
                            {Kind::kFirstMomentX, "link_2", l * (c2 * a - s2 * w) + g * c12,
                             l * (c2 * motion.qdd[0] + s2 * w1) + g * c12},
                            {Kind::kFirstMomentY, "link_2", -l * (s2 * a + c2 * w) - g * s12,
                             l * (-s2 * motion.qdd[0] + c2 * w1) - g * s12},
                            {Kind::kFirstMomentZ, "link_2", 0, 0},
                            {Kind::kInertiaZZ, "link_2", both, both},
                            {Kind::kInertiaXX, "link_2", 0, 0},
                            {Kind::kInertiaXY, "link_2", 0, 0},
                            {Kind::kInertiaXZ, "link_2", 0, 0},
                            {Kind::kInertiaYY, "link_2", 0, 0},
                            {Kind::kInertiaYZ, "link_2", 0, 0},
                            {Kind::kRotorInertia, "joint_2", 0, motion.qdd[1]},
                            {Kind::kDamping, "joint_1", motion.qd[0], 0},
                            {Kind::kCoulomb, "joint_2", 0, 1},
                            {Kind::kOffset, "joint_1", 1, 0}};
  const Columns columns(mechanism, scene, allParameters(mechanism, scene), motion);
  constexpr double kClosedForm = 1e-13;  // a few roundings of numbers up to 30
  for (const Entry& entry : kEntries) {
    EXPECT_NEAR(columns.of(entry.kind, entry.link, 0), entry.first, kClosedForm)
        << nameOf(entry.kind) << entry.link;
    EXPECT_NEAR(columns.of(entry.kind, entry.link, 1), entry.second, kClosedForm)
        << nameOf(entry.kind) << entry.link;
  }
}

// Where loops carry loads to motors, and friction of passive joints as well.
TEST(Regressor, HoldsForClosedLoops) {
  for (const char* name : {"four_bar", "planar_3rrr", "stewart_gough"}) {
    LoopExample example(name);
    example.scene.applied_wrenches.clear();
    example.scene.springs.clear();
    example.scene.payloads.clear();
    example.scene.joints.clear();
    for (const int joint : example.mechanism.coordinates()) {
      JointTerms terms;
      terms.joint = example.mechanism.joint(joint).name;
      terms.damping = 0.3 + joint;
      terms.rotor_inertia = 0.1 * joint;
      terms.offset = 0.5 - joint;
      example.scene.joints.push_back(terms);
    }
    const Dynamics dynamics(example.mechanism, example.scene);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    Motion motion(dynamics.coordinates());
    motion.q = dynamics.assembly();
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      motion.qd[i] = std::cos(2 * static_cast<double>(i));
      motion.qdd[i] = std::sin(3 - static_cast<double>(i));
    }
    ASSERT_TRUE(dynamics.complete(motion, workspace)) << name;
    dynamics.compute(motion, workspace);
    const Columns columns(example.mechanism, example.scene,
                          allParameters(example.mechanism, example.scene), motion);
    const Eigen::VectorXd described = columns.described();
    const Eigen::VectorXd sum = columns.values * described;
    const double size = (columns.values.cwiseAbs() * described.cwiseAbs()).maxCoeff() +
                        columns.values.cwiseAbs().maxCoeff();
    const Eigen::VectorXd& effort = workspace.results().effort;
    ASSERT_EQ(sum.size(), effort.size());
    EXPECT_GT(effort.cwiseAbs().maxCoeff(), 1e-3);
    constexpr double kLoops = 100;  // roundings more, of solving for the loops' forces
    for (Eigen::Index i = 0; i < sum.size(); ++i) {
      EXPECT_LE(std::abs(sum[i] - effort[i]), kLoops * kRounding * size) << name << i;
    }
  }
}

TEST(Regressor, RefusesWhatNoEffortDependsOn) {
  RobotBuilder builder(1);
  builder.add(JointType::kFixed, 0, Vector3l::Zero(), Matrix3l::Identity(), Vector3l::Zero());
  builder.add(1);
  const Mechanism mechanism = builder.build();
  EXPECT_EQ(bodies(mechanism), std::vector<std::string>{"link_2"});
  for (const char* link : {"link_0", "link_1"}) {
    try {
      inertialParameters(mechanism, link);
      ADD_FAILURE() << link;
    } catch (const SceneError& error) {
      EXPECT_EQ(error.what(), "parameters: no joint moves '" + std::string(link) +
                                  "', so that no effort depends on its mass");
    }
  }
  EXPECT_THROW(inertialParameters(mechanism, "nothing"), SceneError);
  EXPECT_THROW(RegressorColumn(mechanism, Scene(), {ParameterKind::kDamping, "nothing", 0}, 1),
               SceneError);
}

}  // namespace
}  // namespace virtual_work_dynamics
