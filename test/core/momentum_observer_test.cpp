#include "virtual_work_dynamics/momentum_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "dynamics/momentum_terms.h"
#include "moving_roots.h"
#include "newton_euler_oracle.h"
#include "random_cases.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Derivative of a function of a number by differences of sixth order: its error is that of the
// seventh derivative times kStep^6 / 140.
constexpr double kStep = 1.0 / 256;
template <typename Function>
auto derivative(Function at) {
  using Value = decltype(at(0.0));
  const Value one = at(kStep) - at(-kStep), two = at(2 * kStep) - at(-2 * kStep);
  const Value three = at(3 * kStep) - at(-3 * kStep);
  return Value((45 * one - 9 * two + three) / (60 * kStep));
}

// Kinetic energy in axes that do not turn and move along with the root's origin, by the motion of
// each link as Newton's and Euler's equations have it.
long double energyOf(const Mechanism& mechanism, const Motion& motion) {
  Scene scene;
  scene.root_moves = true;
  const NewtonEulerOracle state(mechanism, scene, motion);
  long double energy = 0;
  for (std::size_t i = 0; i < mechanism.links().size(); ++i) {
    const auto link = static_cast<int>(i);
    const Vector3l w = state.angularVelocity(link);
    const Vector3l v =
        state.originVelocity(link) + w.cross(state.centreOfMass(link) - state.origin(link));
    const Vector3l w_K = state.orientation(link).transpose() * w;
    energy += (mechanism.link(link).mass * v.squaredNorm() +
               w_K.dot(mechanism.link(link).inertia_Cm_K * w_K)) /
              2;
  }
  return energy;
}

TEST(MomentumTerms, AreTheDerivativesOfTheKineticEnergy) {
  RandomCases cases(11);
  std::mt19937 generator(11);
  double worst_momentum = 0, worst_gradient = 0, largest = 0;
  for (int i = 0; i < 60; ++i) {
    const Case one = cases.next();
    Motion motion = one.motion;
    if (i % 2 == 0) motion.root = randomRootMotion(generator);
    motion.root.velocity.setZero();
    MomentumTerms terms(one.mechanism);
    const RootMotion& root = motion.root;
    terms.compute(motion, root.orientation.conjugate() * root.angular_velocity);
    const auto scale = static_cast<double>(1 + energyOf(one.mechanism, motion));
    for (Eigen::Index k = 0; k < motion.q.size(); ++k) {
      const auto along = [&](Eigen::VectorXd Motion::*part) {
        return static_cast<double>(derivative([&](double step) {
          Motion moved = motion;
          (moved.*part)[k] += step;
          return energyOf(one.mechanism, moved);
        }));
      };
      const double momentum = along(&Motion::qd), gradient = along(&Motion::q);
      ASSERT_TRUE(std::isfinite(terms.momentum()[k] + terms.gradient()[k]));
      worst_momentum = std::max(worst_momentum, std::abs(terms.momentum()[k] - momentum) / scale);
      worst_gradient = std::max(worst_gradient, std::abs(terms.gradient()[k] - gradient) / scale);
      largest = std::max(largest, std::abs(gradient) / scale);
    }
  }
  // Of doubles, with the rounding of positions, 2^-51, over the step; and of the differences.
  EXPECT_LT(worst_momentum, 1e-12);
  EXPECT_LT(worst_gradient, 1e-11);
  EXPECT_GT(largest, 0.1);
  RecordProperty("momentum", std::to_string(worst_momentum * 1e12) + "e-12");
  RecordProperty("gradient", std::to_string(worst_gradient * 1e12) + "e-12");
}

// With rotors, friction, springs, payloads, wrenches and a root that turns and accelerates, efforts
// are the rate of change of the momentum less what else changes it.
TEST(MomentumObserver, MomentaChangeByTheComputedEfforts) {
  RandomCases cases(12);
  std::mt19937 generator(12);
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    Case one = cases.next();
    one.scene.static_motion = false;
    one.scene.root_moves = i % 2 == 0;
    Payload payload;
    payload.link = one.mechanism.links().back().name;
    payload.mass = 1.5;
    payload.at = {0.1, -0.2, 0.05};
    one.scene.payloads = {payload};
    const Load load(one.scene);
    RootMotion root = randomRootMotion(generator);
    root.velocity.setZero();
    root.angular_acceleration.setZero();
    const Eigen::Vector3d turn = root.angular_velocity;
    // The motion at a time: constant accelerations, and a root that turns about an axis at rest.
    const auto at = [&](double t) {
      Motion motion = one.motion;
      motion.q += t * one.motion.qd + t * t / 2 * one.motion.qdd;
      motion.qd += t * one.motion.qdd;
      motion.root = root;
      motion.root.orientation =
          Eigen::AngleAxisd(t * turn.norm(), turn.normalized()) * root.orientation;
      return motion;
    };
    MomentumObserver observer(one.mechanism, one.scene, 1);
    const Eigen::VectorXd measured = Eigen::VectorXd::Zero(one.motion.q.size());
    const auto sampled = [&](double t) {
      observer.restart();
      observer.step(t, at(t), load, measured);
    };
    const Eigen::VectorXd rate = derivative([&](double t) {
      sampled(t);
      return Eigen::VectorXd(observer.momentum());
    });
    sampled(0);
    Request request;
    const Dynamics dynamics(one.mechanism, one.scene, request);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(at(0), load, workspace);
    const Eigen::VectorXd effort = workspace.results().effort;
    const double scale = 1 + effort.cwiseAbs().sum() + rate.cwiseAbs().sum();
    ASSERT_TRUE(effort.allFinite() && rate.allFinite());
    if (effort.size() == 0) continue;
    const Eigen::VectorXd error = rate - observer.momentumRate() - effort;
    worst = std::max(worst, error.cwiseAbs().maxCoeff() / scale);
  }
  // Differences of sixth order of some 10 rad/s: (10 / 256)^6 / 140 = 2.5e-11; of doubles 1e-13.
  EXPECT_LT(worst, 1e-9);
}

// A mass on a slide, whose momentum is 2 qd exactly.
constexpr char kSlide[] = R"(<robot name="slide"><link name="base"/>
  <link name="mass"><inertial><mass value="2"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="mass"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)";

TEST(MomentumObserver, FollowsAConstantForceExactlyWhateverTheSteps) {
  constexpr double kGain = 25, kForce = 20;
  const Mechanism mechanism = readUrdf(kSlide);
  const Scene scene;
  MomentumObserver observer(mechanism, scene, kGain);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> steps(1e-4, 0.02);
  double t = 0;
  for (int i = 0; i < 300; ++i) {
    // The motor pushes with 3 - 2 t, the outside with kForce.
    const double force = 3 - 2 * t;
    Motion motion(1);
    motion.qd[0] = (3 * t - t * t + kForce * t) / 2;
    observer.step(t, motion, Load(), Eigen::VectorXd::Constant(1, force));
    EXPECT_NEAR(observer.external()[0], kForce * (1 - std::exp(-kGain * t)), 1e-10 * (1 + t * t));
    t += steps(generator);
  }
  EXPECT_NEAR(observer.external()[0], kForce, 1e-9);  // the sign
}

// Two links in a vertical plane, by the textbook: q from the horizontal, gravity along -z.
struct TwoLinks {
  static constexpr double l = 0.5, m1 = 3, m2 = 2, c1 = 0.2, c2 = 0.3, I1 = 0.05, I2 = 0.04,
                          g = 9.81;

  static std::string urdf() {
    return R"(<robot name="two_links"><link name="base"/>
  <link name="upper"><inertial><origin xyz="0.2 0 0"/><mass value="3"/>
    <inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0.3 0 0"/><mass value="2"/>
    <inertia ixx="0.01" iyy="0.04" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/>
    <axis xyz="0 -1 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 -1 0"/></joint></robot>)";
  }

  static Eigen::Matrix2d mass(const Eigen::Vector2d& q) {
    const double k = m2 * l * c2 * std::cos(q[1]), d = I2 + m2 * c2 * c2;
    Eigen::Matrix2d M;
    M << I1 + m1 * c1 * c1 + m2 * l * l + d + 2 * k, d + k, d + k, d;
    return M;
  }
  static Eigen::Vector2d efforts(const Eigen::Vector2d& q, const Eigen::Vector2d& qd,
                                 const Eigen::Vector2d& qdd) {
    const double s = m2 * l * c2 * std::sin(q[1]);
    const double lower = m2 * g * c2 * std::cos(q[0] + q[1]);
    return mass(q) * qdd + Eigen::Vector2d(-s * qd[1] * (2 * qd[0] + qd[1]), s * qd[0] * qd[0]) +
           Eigen::Vector2d((m1 * c1 + m2 * l) * g * std::cos(q[0]) + lower, lower);
  }
};

Eigen::Vector2d positionAt(double t) {
  return {std::sin(3 * t) + 0.3, 1.2 * std::cos(2.2 * t)};
}
Eigen::Vector2d velocityAt(double t) {
  return {3 * std::cos(3 * t), -2.64 * std::sin(2.2 * t)};
}
Eigen::Vector2d accelerationAt(double t) {
  return {-9 * std::sin(3 * t), -5.808 * std::cos(2.2 * t)};
}
Eigen::Vector2d pushAt(double t) {
  return t < 0.5 ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(4 + std::sin(20 * t), -2.5);
}

// Largest error of the estimate against the low-pass of the push, by its own equation on a hundred
// times finer grid.
double observedError(double step, const std::function<double()>& jitter) {
  constexpr double kGain = 30;
  const Mechanism mechanism = readUrdf(TwoLinks::urdf());
  const Scene scene;
  MomentumObserver observer(mechanism, scene, kGain);
  Eigen::Vector2d expected(0, 0);
  double worst = 0, passed = 0;
  for (double at = 0; at < 2; at += step) {
    const double t = at + step * jitter();
    while (passed + step / 100 < t) {
      const double h = step / 100;
      expected += (1 - std::exp(-kGain * h)) * (pushAt(passed + h / 2) - expected);
      passed += h;
    }
    Motion motion(2);
    motion.q = positionAt(t);
    motion.qd = velocityAt(t);
    motion.qdd.setConstant(kNaN);  // it is not looked at
    const Eigen::Vector2d motors =
        TwoLinks::efforts(motion.q, motion.qd, accelerationAt(t)) - pushAt(t);
    observer.step(t, motion, Load(), motors);
    // At the jump of the push, measured efforts jump between two samples as well.
    worst = std::max(worst, (observer.external() - expected).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(MomentumObserver, FollowsAPushOnTheTextbooksTwoLinksAsALowPassDoes) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  const auto jittered = [&] { return jitter(generator); };
  // The jump of 4 N m in one step is off by up to K h 4 / 2 N m.
  EXPECT_LT(observedError(1e-3, jittered), 30 * 1e-3 * 1.3 * 4);
  EXPECT_LT(observedError(1e-4, jittered), 30 * 1e-4 * 1.3 * 4);
}

TEST(MomentumObserver, SaysWhatIsNotKnownAndStartsAnew) {
  const Mechanism mechanism = readUrdf(TwoLinks::urdf());
  const Scene scene;
  MomentumObserver observer(mechanism, scene, 10);
  EXPECT_TRUE(observer.external().array().isNaN().all());
  Motion motion(2);
  const auto step = [&](double t, double shoulder, double elbow) {
    observer.step(t, motion, Load(), Eigen::Vector2d(shoulder, elbow));
    return Eigen::Vector2d(observer.external());
  };
  EXPECT_EQ(step(0, 1, kNaN)[0], 0);
  EXPECT_TRUE(std::isnan(observer.external()[1]));
  const double first = step(0.1, 1, 2)[0];
  EXPECT_NE(first, 0);
  EXPECT_EQ(observer.external()[1], 0);
  EXPECT_NE(step(0.2, 1, 2)[1], 0);
  EXPECT_THROW(step(0.2, 1, 2), MotionError);
  EXPECT_THROW(observer.step(1, motion, Load(), Eigen::VectorXd::Zero(1)), MotionError);
  observer.restart();
  EXPECT_TRUE(observer.external().array().isNaN().all());
  EXPECT_EQ(step(0.1, 1, 2)[0], 0);
}

std::string refusal(const Mechanism& mechanism, const Scene& scene, double gain) {
  try {
    const MomentumObserver observer(mechanism, scene, gain);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(MomentumObserver, RefusesInOneLineWhatItDoesNotKnow) {
  const Mechanism mechanism = readUrdf(TwoLinks::urdf());
  EXPECT_EQ(refusal(mechanism, Scene(), 0),
            "momentum observer: the gain 0 1/s is not a positive "
            "number");
  EXPECT_NE(refusal(mechanism, Scene(), kNaN), "");
  Scene still;
  still.static_motion = true;
  EXPECT_EQ(refusal(mechanism, still, 1), "momentum observer: a static scene has no momentum");
  Scene passive;
  passive.actuated = std::vector<std::string>{"shoulder"};
  EXPECT_EQ(refusal(mechanism, passive, 1),
            "momentum observer: closed loops and passive joints are not observed");
  const Mechanism free = readUrdf(R"(<robot name="free"><link name="base"/>
    <link name="body"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="flight" type="floating"><parent link="base"/><child link="body"/></joint></robot>)");
  EXPECT_EQ(refusal(free, Scene(), 1),
            "momentum observer: joint 'flight' turns freely, which is not observed");
}

}  // namespace
}  // namespace virtual_work_dynamics
