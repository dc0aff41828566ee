#include "dynamics/effort_doubts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

// Three joints of which one level of one coordinate is known badly.
class EffortDoubtsOf : public testing::Test {
 protected:
  EffortDoubtsOf()
      : builder_(chainOf(3)), mechanism_(builder_.build()), motion_(builder_.motion()) {
    Scene scene;
    scene.tolerances.mass = 0.01;
    deviations_.emplace_back(mechanism_, scene, Request());
    const Dynamics dynamics(mechanism_, scene, Request());
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion_, workspace);
    effort_ = workspace.results().effort;
  }

  EffortDoubts doubts() const {
    return EffortDoubts(deviations_.front().effortNames(), deviations_.front().residuals(),
                        mechanism_.coordinateNames());
  }
  Deviations::Workspace computed(std::size_t coordinate, int level, double deviation) const {
    Deviations::Workspace workspace = deviations_.front().makeWorkspace();
    MotionCovariance covariance{std::vector<Eigen::Matrix3d>(3, Eigen::Matrix3d::Zero())};
    covariance.coordinates[coordinate](level, level) = deviation * deviation;
    deviations_.front().computeMotion(motion_, covariance, workspace);
    deviations_.front().computeDescription(motion_, workspace);
    return workspace;
  }

  RobotBuilder builder_;
  Mechanism mechanism_;
  Motion motion_;
  std::vector<Deviations> deviations_;
  Eigen::VectorXd effort_;
};

TEST_F(EffortDoubtsOf, NamesJointAndCause) {
  const char* const kLevels[] = {"position", "velocity", "acceleration"};
  for (std::size_t coordinate = 0; coordinate < 3; ++coordinate) {
    for (int level = 0; level < 3; ++level) {
      EffortDoubts all = doubts();
      const Deviations::Workspace of = computed(coordinate, level, 0.5);
      all.add(effort_, of, true, true);
      const auto found = all.above(1e-6);
      ASSERT_EQ(found.size(), 3u);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(found[i].name, mechanism_.coordinateNames()[i]);
        const double motion = of.motion().effort[static_cast<Eigen::Index>(i)];
        const double description = of.description().effort[static_cast<Eigen::Index>(i)];
        const double both = std::hypot(motion, description);
        EXPECT_NEAR(found[i].deviation, both, 1e-12 * both);
        const std::string level_name = kLevels[level];
        const std::string noise = i == coordinate
                                      ? "the noise of its own " + level_name
                                      : "the noise of the " + level_name + " of '" +
                                            mechanism_.coordinateNames()[coordinate] + "'";
        EXPECT_EQ(found[i].cause,
                  motion > description ? noise : "the tolerances of masses and inertias");
      }
    }
  }
}

TEST_F(EffortDoubtsOf, ComparesTheRmsOfBoth) {
  const Deviations::Workspace of = computed(0, 2, 1);
  EffortDoubts all = doubts();
  // One sample with the effort and three without any: half of the rms.
  all.add(effort_, of, true, false);
  for (int i = 0; i < 3; ++i) all.add(Eigen::VectorXd::Zero(3), of, true, false);
  EXPECT_EQ(all.samples(), 4u);
  const double share = of.motion().effort[0] / (std::abs(effort_[0]) / 2);
  EXPECT_EQ(all.above(1.001 * share).size() + 1, all.above(0.999 * share).size());
  EXPECT_NEAR(all.above(0.999 * share).front().relative, share, 1e-12 * share);
  all.forgetDeviations();
  EXPECT_EQ(all.samples(), 0u);
  EXPECT_TRUE(all.above(1e-9).empty());
  all.add(effort_, of, true, false);  // two of five samples now have the effort
  const double later = of.motion().effort[0] / (std::abs(effort_[0]) * std::sqrt(0.4));
  EXPECT_NEAR(all.above(1e-9).front().relative, later, 1e-12 * later);
}

TEST_F(EffortDoubtsOf, LeavesOutWhatHasNoValue) {
  const Deviations::Workspace of = computed(0, 2, 1);
  EffortDoubts all = doubts();
  Eigen::VectorXd nothing = effort_;
  nothing[1] = std::numeric_limits<double>::quiet_NaN();
  all.add(nothing, of, true, false);
  const auto found = all.above(0);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].name, mechanism_.coordinateNames()[2]);
}

TEST(EffortDoubt, IsOneLine) {
  EXPECT_EQ(toString(EffortDoubt{"elbow", 0.812, 0.2345, "the noise of its own velocity"}),
            "effort of 'elbow': deviation 0.81, 23 % of its rms, mostly from the noise of its own "
            "velocity");
  EXPECT_EQ(toString(EffortDoubt{"j", 2, std::numeric_limits<double>::infinity(), "x"}),
            "effort of 'j': deviation 2, while the effort is zero, mostly from x");
}

}  // namespace
}  // namespace virtual_work_dynamics
