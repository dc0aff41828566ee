#include "virtual_work_dynamics/certificates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/instruction_set.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Recursion and certifier round the terms of twenty bodies a dozen times each: some ten times
// 2^-52, relative to the sum of their magnitudes.
constexpr double kRounding = 4e-15;
// An error that is seen is seen in its true size except for that rounding.
constexpr double kPlanted = 1e-9;
constexpr double kSeen = 1e-4;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Lets Certifiers be built for an instruction set.
class InstructionSetChoice {
 public:
  explicit InstructionSetChoice(InstructionSet set) : before_(toString(chosenInstructionSet())) {
    setenv(kInstructionSetVariable, toString(set).c_str(), 1);
  }
  ~InstructionSetChoice() { setenv(kInstructionSetVariable, before_.c_str(), 1); }

 private:
  std::string before_;
};

// Results of one motion with a certifier for them.
struct Certified {
  Certified(const Mechanism& mechanism, const Scene& scene, const Motion& the_motion)
      : motion(the_motion), certifier(mechanism, scene), bound(mechanism, scene) {
    const InverseDynamics dynamics(mechanism, scene, Certifier::extended(Request()));
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    effort = workspace.effort();
    ground = workspace.childAxes()[Certifier::groundIndex(dynamics.request())];
    bound.compute(motion);
  }

  Certificates check() { return certifier.check(motion, effort, ground); }

  Motion motion;
  Certifier certifier;
  ErrorBound bound;
  Eigen::VectorXd effort;
  Wrench ground;
};

void addWrenches(const Mechanism& mechanism, RandomRobot& source, Scene& scene) {
  scene.applied_wrenches.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    AppliedWrench& applied = scene.applied_wrenches[i];
    applied.link = mechanism.links()[source.pick(static_cast<int>(mechanism.links().size()))].name;
    applied.axes = i == 1 ? Axes::kRoot : Axes::kLink;
    applied.at << source.uniform(-1, 1), source.uniform(-1, 1), source.uniform(-1, 1);
    applied.force << source.uniform(-20, 20), source.uniform(-20, 20), source.uniform(-20, 20);
    applied.torque << source.uniform(-5, 5), source.uniform(-5, 5), source.uniform(-5, 5);
  }
}

void addTerms(const Mechanism& mechanism, RandomRobot& source, Scene& scene) {
  for (const Joint& joint : mechanism.joints()) {
    if (joint.type == JointType::kFixed || source.pick(2) == 0) continue;
    scene.joints.push_back({joint.name, source.uniform(0, 50), source.uniform(-2, 2),
                            source.uniform(0, 9), source.uniform(0, 9), source.uniform(0.1, 4),
                            source.uniform(0, 3)});
  }
}

// All kinds of joints, fixed ones and bodies without mass among them; see RandomRobot.
struct RandomCase {
  explicit RandomCase(unsigned seed)
      : source(seed, 2 + static_cast<int>(seed) % 20), mechanism(readUrdf(source.urdf())) {
    scene.gravity << 2, -9, 4;
    if (seed % 2) addWrenches(mechanism, source, scene);
    if (seed % 3) addTerms(mechanism, source, scene);
  }

  RandomRobot source;
  Mechanism mechanism;
  Scene scene;
};

Mechanism scaled(const Mechanism& from, long double mass, long double length) {
  std::vector<Link> links = from.links();
  std::vector<Joint> joints = from.joints();
  for (Link& link : links) {
    link.mass *= mass;
    link.p_KoCm_K *= length;
    link.inertia_Cm_K *= mass * length * length;
  }
  for (Joint& joint : joints) joint.p_PoKo_P *= length;
  return Mechanism(from.name(), links, joints);
}

void expectRounding(const Certificates& found, const std::string& what, double& worst) {
  ASSERT_TRUE(std::isfinite(found.largest())) << what;
  EXPECT_LE(found.power, kRounding) << what;
  EXPECT_LE(found.ground_force, kRounding) << what;
  EXPECT_LE(found.ground_moment, kRounding) << what;
  worst = std::max(worst, found.largest());
}

TEST(Certifier, SmallForRandomTreesOnEveryInstructionSet) {
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2}) {
    if (!isSupported(set)) continue;
    const InstructionSetChoice choice(set);
    double worst = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
      RandomCase random(seed);
      for (const double rate : {1.0, 100.0}) {
        const Motion motion = random.source.motion(random.mechanism, rate);
        Certified results(random.mechanism, random.scene, motion);
        expectRounding(results.check(), toString(set) + ", seed " + std::to_string(seed), worst);
      }
    }
    std::cout << "  worst, " << toString(set) << ": " << worst << "\n";
  }
}

TEST(Certifier, SmallAtEveryScale) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    RandomCase random(seed);
    for (const long double mass : {1e-9L, 1e9L}) {
      for (const long double length : {1e-9L, 1e9L}) {
        const Mechanism mechanism = scaled(random.mechanism, mass, length);
        for (const double rate : {1e-6, 1.0, 1e6}) {
          Certified results(mechanism, random.scene, random.source.motion(mechanism, rate));
          expectRounding(results.check(), "seed " + std::to_string(seed), worst);
        }
      }
    }
  }
  std::cout << "  worst: " << worst << "\n";
}

// A last digit of such angles is 1e-7 to 1e-4 rad: much also when it is squared.
TEST(Certifier, SmallAtLargeAnglesOfGears) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RobotBuilder builder = chainOf(3, seed);
    builder.add(3);
    builder.mimicFirst(-0.3, 1e8 + 0.1);
    builder.add(4);
    const Mechanism mechanism = builder.build();
    for (const double angle : {1e9, 1e12}) {
      Motion motion = builder.motion();
      motion.q *= angle;
      Certified results(mechanism, Scene(), motion);
      expectRounding(results.check(), "seed " + std::to_string(seed), worst);
    }
  }
  std::cout << "  worst: " << worst << "\n";
}

void expectSeen(double certificate, double size) {
  EXPECT_NEAR(certificate, size, kSeen * size + kRounding);
}

// The scales are ErrorBound's, found in another way.
TEST(Certifier, SeesAnErrorOfGroundAsLargeAsItIs) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    RandomCase random(seed);
    Certified results(random.mechanism, random.scene, random.source.motion(random.mechanism));
    const WrenchMagnitude& scale = results.bound.wrenches()[0];
    for (int i = 0; i < 3; ++i) {
      const Wrench right = results.ground;
      results.ground.force[i] += kPlanted * scale.force;
      Certificates found = results.check();
      expectSeen(found.ground_force, scale.force > 0 ? kPlanted : 0);
      EXPECT_LE(std::max(found.power, found.ground_moment), kRounding);
      results.ground = right;
      results.ground.torque[i] += kPlanted * scale.moment;
      found = results.check();
      expectSeen(found.ground_moment, scale.moment > 0 ? kPlanted : 0);
      EXPECT_LE(std::max(found.power, found.ground_force), kRounding);
      results.ground = right;
    }
  }
}

TEST(Certifier, SeesAnErrorOfAnyEffortByItsPower) {
  int planted = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    RandomCase random(seed);
    Certified results(random.mechanism, random.scene, random.source.motion(random.mechanism));
    const std::vector<double>& scales = results.bound.efforts();
    double scale = 0;
    for (std::size_t c = 0; c < scales.size(); ++c) {
      scale += scales[c] * std::abs(results.motion.qd[c]);
    }
    for (std::size_t c = 0; c < scales.size(); ++c) {
      if (scale == 0) continue;
      const double right = results.effort[c];
      results.effort[c] += kPlanted * scale / std::abs(results.motion.qd[c]);
      const Certificates found = results.check();
      expectSeen(found.power, kPlanted);
      EXPECT_LE(std::max(found.ground_force, found.ground_moment), kRounding);
      results.effort[c] = right;
      ++planted;
    }
  }
  EXPECT_GT(planted, 100);
}

TEST(Certifier, SeesThatAppliedWrenchesAndTermsAreMissing) {
  RandomCase random(5);
  const Motion motion = random.source.motion(random.mechanism);
  Certified results(random.mechanism, random.scene, motion);
  Scene without = random.scene;
  without.applied_wrenches.clear();
  Certifier blind(random.mechanism, without);
  Certificates found = blind.check(motion, results.effort, results.ground);
  EXPECT_GT(found.power, 1e-6);
  EXPECT_GT(found.ground_force, 1e-6);
  EXPECT_GT(found.ground_moment, 1e-6);
  without = random.scene;
  ASSERT_FALSE(without.joints.empty());
  without.joints.clear();
  Certifier slack(random.mechanism, without);
  found = slack.check(motion, results.effort, results.ground);
  EXPECT_GT(found.power, 1e-6);
  EXPECT_LE(std::max(found.ground_force, found.ground_moment), kRounding);
}

void expectEqual(const Certificates& a, const Certificates& b) {
  EXPECT_EQ(a.power, b.power);
  EXPECT_EQ(a.ground_force, b.ground_force);
  EXPECT_EQ(a.ground_moment, b.ground_moment);
}

TEST(Certifier, CertifiesWhatWasComputedWithALoad) {
  RandomCase random(5);
  const Motion motion = random.source.motion(random.mechanism);
  Scene scene = random.scene;
  for (AppliedWrench& applied : scene.applied_wrenches) applied.force << 7, -8, 9;
  Certified results(random.mechanism, scene, motion);
  Certifier certifier(random.mechanism, random.scene);
  const Certificates own = certifier.check(motion, results.effort, results.ground);
  EXPECT_GT(own.largest(), 1e-6);
  Load load(scene);
  for (int i = 0; i < 2; ++i) {
    const Certificates found = certifier.check(motion, load, results.effort, results.ground);
    EXPECT_LE(found.largest(), kRounding);
    expectEqual(found, results.check());
    expectEqual(certifier.check(motion, results.effort, results.ground), own);
  }
  load.wrenches.resize(4);
  EXPECT_THROW(certifier.check(motion, load, results.effort, results.ground), SceneError);
  load.wrenches.resize(2);
  EXPECT_THROW(certifier.check(motion, load, results.effort, results.ground), SceneError);
}

TEST(Certifier, HasNoPowerAtRest) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    RandomCase random(seed);
    random.scene.static_motion = true;
    Certified results(random.mechanism, random.scene, random.source.motion(random.mechanism));
    EXPECT_EQ(results.check().power, 0);
    expectRounding(results.check(), "seed " + std::to_string(seed), worst);
    results.ground.force[1] += kPlanted * results.bound.wrenches()[0].force;
    expectSeen(results.check().ground_force, results.bound.wrenches()[0].force > 0 ? kPlanted : 0);
  }
}

TEST(Certifier, NothingToCompareIsZero) {
  RobotBuilder builder = chainOf(2);
  for (const int link : {1, 2}) builder.removeInertia(link);
  Certified results(builder.build(), Scene(), builder.motion());
  EXPECT_EQ(results.check().largest(), 0);
  results.ground.force[2] = 1e-6;  // but then nothing is not what was found
  EXPECT_GT(results.check().ground_force, 1);
}

TEST(Certifier, ResultsThatAreNoNumbersNeverPass) {
  for (const bool rests : {false, true}) {
    RandomCase random(7);
    random.scene.static_motion = rests;
    Certified results(random.mechanism, random.scene, random.source.motion(random.mechanism));
    const auto expectCaught = [&](double& number, double Certificates::*certificate) {
      const double right = number;
      for (const double wrong : {kNaN, kInfinity, -kInfinity}) {
        number = wrong;
        EXPECT_FALSE(std::isfinite(results.check().*certificate));
        EXPECT_FALSE(std::isfinite(results.check().largest()));
      }
      number = right;
    };
    for (Eigen::Index c = 0; c < results.effort.size(); ++c) {
      expectCaught(results.effort[c], &Certificates::power);
    }
    for (int i = 0; i < 3; ++i) {
      expectCaught(results.ground.force[i], &Certificates::ground_force);
      expectCaught(results.ground.torque[i], &Certificates::ground_moment);
    }
  }
}

TEST(Certifier, MotionsThatAreTooLargeNeverPass) {
  RandomCase random(7);
  Motion motion = random.source.motion(random.mechanism);
  motion.qd *= 1e200;  // whose square overflows
  Certified results(random.mechanism, random.scene, motion);
  const Certificates found = results.check();
  EXPECT_FALSE(std::isfinite(found.power));
  EXPECT_FALSE(std::isfinite(found.ground_force));
  EXPECT_FALSE(std::isfinite(found.ground_moment));
}

// A finite difference of an infinite scale would be none.
TEST(Certifier, ScalesThatOverflowCertifyNothing) {
  const Mechanism mechanism = chainOf(1).build();
  Scene scene;
  scene.static_motion = true;
  scene.applied_wrenches.resize(2);
  for (AppliedWrench& applied : scene.applied_wrenches) {
    applied.link = "link_0";
    applied.axes = Axes::kRoot;
    applied.force << 1e308, 0, 0;
  }
  scene.applied_wrenches[1].force *= -1;
  Certified results(mechanism, scene, Motion(1));
  EXPECT_TRUE(results.ground.force.allFinite());
  EXPECT_TRUE(std::isnan(results.check().ground_force));
  EXPECT_LE(results.check().ground_moment, kRounding);
}

TEST(Certificates, LargestIsNaNWhenAnyIs) {
  EXPECT_EQ((Certificates{1, 2, 3}.largest()), 3);
  EXPECT_EQ((Certificates{1, 5, 3}.largest()), 5);
  EXPECT_EQ((Certificates{7, 5, 3}.largest()), 7);
  EXPECT_TRUE(std::isnan(Certificates{kNaN, 2, 3}.largest()));
  EXPECT_TRUE(std::isnan(Certificates{1, kNaN, 3}.largest()));
  EXPECT_TRUE(std::isnan(Certificates{1, 2, kNaN}.largest()));
}

TEST(Certifier, ExtendsRequests) {
  Request request;
  request.efforts = false;
  request.root_axes = {"a", kGround};
  Request extended = Certifier::extended(request);
  EXPECT_TRUE(extended.efforts);
  EXPECT_EQ(extended.child_axes, (std::vector<std::string>{kGround}));
  EXPECT_EQ(extended.root_axes, request.root_axes);
  EXPECT_EQ(Certifier::groundIndex(extended), 0u);

  request.child_axes = {"b", "c"};
  extended = Certifier::extended(request);
  EXPECT_EQ(extended.child_axes, (std::vector<std::string>{"b", "c", kGround}));
  EXPECT_EQ(Certifier::groundIndex(extended), 2u);

  request.child_axes = {kGround, "b"};
  EXPECT_EQ(Certifier::extended(request).child_axes, request.child_axes);
  EXPECT_EQ(Certifier::groundIndex(request), 0u);
  EXPECT_THROW(Certifier::groundIndex(Request()), SceneError);
}

TEST(Certifier, RefusesWhatInverseDynamicsRefuses) {
  RobotBuilder builder = chainOf(2);
  const Mechanism mechanism = builder.build();
  Certifier certifier(mechanism, Scene());
  const Eigen::VectorXd effort = Eigen::VectorXd::Zero(2);
  EXPECT_NO_THROW(certifier.check(Motion(2), effort, Wrench()));
  EXPECT_THROW(certifier.check(Motion(3), effort, Wrench()), MotionError);
  EXPECT_THROW(certifier.check(Motion(2), Eigen::VectorXd::Zero(0), Wrench()), MotionError);
  Scene scene;
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].link = "nowhere";
  EXPECT_THROW(Certifier(mechanism, scene), SceneError);
  scene.applied_wrenches.clear();
  scene.joints.resize(1);
  scene.joints[0].joint = "nowhere";
  EXPECT_THROW(Certifier(mechanism, scene), SceneError);
}

}  // namespace
}  // namespace virtual_work_dynamics
