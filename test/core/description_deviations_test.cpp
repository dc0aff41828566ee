#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "four_bar.h"
#include "random_motions.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Differences of results that are linear in what changes: a few roundings.
constexpr double kLinear = 1e-10;

Request all(const Mechanism& mechanism, const Scene& scene) {
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  return request;
}

std::vector<double> numbersAt(const Mechanism& mechanism, const Scene& scene,
                              const Motion& motion) {
  const Dynamics dynamics(mechanism, scene, all(mechanism, scene));
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  return numbersOf(workspace.results());
}

// Results of the mechanism with one mass or one inertia after the other doubled, less its own, are
// what the tolerances are relative to.
void expectShares(const Mechanism& mechanism, Scene scene, const Motion& motion) {
  scene.tolerances = {0.03, 0.2};
  const std::vector<double> own = numbersAt(mechanism, scene, motion);
  std::vector<double> variances(own.size());
  double largest = 0;
  for (std::size_t i = 0; i < mechanism.links().size(); ++i) {
    for (const bool mass : {true, false}) {
      std::vector<Link> links = mechanism.links();
      if (mass) links[i].mass *= 2;
      if (!mass) links[i].inertia_Cm_K *= 2;
      const Mechanism changed(mechanism.name(), links, mechanism.joints());
      const std::vector<double> numbers = numbersAt(changed, scene, motion);
      for (std::size_t k = 0; k < own.size(); ++k) {
        const double change = numbers[k] - own[k];
        variances[k] += std::pow((mass ? 0.03 : 0.2) * change, 2);
        largest = std::max(largest, std::abs(numbers[k]));
      }
    }
  }
  const Deviations deviations(mechanism, scene, all(mechanism, scene));
  EXPECT_TRUE(deviations.hasTolerances());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  deviations.computeDescription(motion, workspace);
  const std::vector<double> found = numbersOf(workspace.description());
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (std::isnan(found[k])) continue;
    EXPECT_NEAR(found[k], std::sqrt(variances[k]), kLinear * largest) << k;
  }
  EXPECT_GT(found.front(), 0);
}

TEST(DescriptionDeviations, SharesOfOpenChainsAreThoseOfChangedMechanisms) {
  for (const unsigned seed : {2u, 5u}) {
    RandomRobot robot(seed, 8);
    const Mechanism mechanism = readUrdf(robot.urdf());
    Scene scene;
    scene.applied_wrenches.resize(1);
    scene.applied_wrenches[0].link = "link_3";
    scene.applied_wrenches[0].force << 100, 200, 300;
    JointTerms terms;
    terms.joint = mechanism.coordinateNames().front();
    terms.damping = 30;
    terms.rotor_inertia = 2;
    scene.joints = {terms};
    expectShares(mechanism, scene, robot.motion(mechanism));
  }
}

TEST(DescriptionDeviations, SharesOfClosedLoopsAreThoseOfChangedMechanisms) {
  const FourBar four_bar;
  for (const char pivot : {'B', 'C', 'D'}) {
    const FourBar::Cut cut = four_bar.cut(pivot);
    FourBar::Cut sprung = cut;
    sprung.scene.springs.push_back(
        {"spring", "crank", "rocker", {0.1, 0, 0}, {0.2, 0, 0}, 40, 0.1});
    expectShares(sprung.mechanism, sprung.scene, cut.motion(four_bar.turnings(1.1, 3.1, -4.2)));
  }
}

TEST(DescriptionDeviations, PendulumMatchesClosedForm) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  Scene scene;
  scene.gravity << 0, -9.81, 0;
  scene.tolerances.mass = 0.1;
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  deviations.computeDescription(Motion(2), workspace);
  // Both rods lie along x: weights of 0.25 kg at 0.25 m and of 1 kg at 0.5 m + 0.375 m.
  const double first = 0.1 * 9.81 * std::hypot(0.25 * 0.25, 1 * 0.875);
  const double second = 0.1 * 9.81 * 0.375;
  EXPECT_NEAR(workspace.description().effort[0], first, 1e-14 * first);
  EXPECT_NEAR(workspace.description().effort[1], second, 1e-14 * second);
}

TEST(DescriptionDeviations, WithoutTolerancesThereIsNoShare) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  const Deviations deviations(mechanism, Scene(), Request());
  EXPECT_FALSE(deviations.hasTolerances());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  deviations.computeDescription(Motion(2), workspace);
  EXPECT_EQ(workspace.description().effort, Eigen::Vector2d::Zero());
}

TEST(DescriptionDeviations, WrongTolerancesThrow) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  for (const double wrong : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Scene scene;
    scene.tolerances.mass = wrong;
    EXPECT_THROW(Deviations(mechanism, scene, Request()), SceneError) << wrong;
    scene.tolerances = {0, wrong};
    EXPECT_THROW(Deviations(mechanism, scene, Request()), SceneError) << wrong;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
