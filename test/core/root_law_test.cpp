#include "motion/root_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tumbling_roots.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

MotionTable tableOf(const TumblingRoot& root, int rows, double step) {
  MotionTable table;
  for (int i = 0; i < rows; ++i) {
    table.times.push_back(7 + i * step);  // the first row is at time zero all the same
    table.roots.push_back(root.at(i * step));
    // A quaternion and its opposite are one attitude.
    if (i % 3 == 1) table.roots.back().orientation.coeffs() *= -1;
  }
  return table;
}

struct Differences {
  double turn = 0, acceleration = 0, angular_acceleration = 0;
};

// Between the rows, at worst.
Differences differences(const RootLaw& law, const TumblingRoot& root, int rows, double step) {
  Differences worst;
  for (int i = 0; i + 1 < rows; ++i) {
    const double t = (i + 0.37) * step;
    const RootMotion found = law.at(t), wanted = root.at(t);
    worst.turn = std::max(worst.turn, angleBetween(found, wanted));
    worst.acceleration =
        std::max(worst.acceleration, (found.acceleration - wanted.acceleration).norm());
    worst.angular_acceleration =
        std::max(worst.angular_acceleration,
                 (found.angular_acceleration - wanted.angular_acceleration).norm());
  }
  return worst;
}

TEST(RootLaw, MeetsItsRowsInEveryAttitude) {
  constexpr int kRows = 400;
  constexpr double kStep = 0.02;
  const TumblingRoot root;
  const RootLaw law(tableOf(root, kRows, kStep));
  EXPECT_TRUE(law.hasAccelerations());
  for (int i = 0; i < kRows; ++i) {
    const RootMotion found = law.at(i * kStep), wanted = root.at(i * kStep);
    EXPECT_LT((found.position - wanted.position).norm(), 1e-12);
    EXPECT_LT((found.velocity - wanted.velocity).norm(), 1e-11);
    EXPECT_LT((found.acceleration - wanted.acceleration).norm(), 1e-9);
    EXPECT_LT(angleBetween(found, wanted), 1e-12);
    EXPECT_LT((found.angular_velocity - wanted.angular_velocity).norm(), 1e-11);
    EXPECT_LT((found.angular_acceleration - wanted.angular_acceleration).norm(), 1e-9);
  }
}

// The error of a quintic's second derivative falls as the fourth power of the step, that of a cubic
// spline's as the second.
TEST(RootLaw, ComesCloserBetweenFinerRows) {
  const TumblingRoot root;
  for (const bool rates : {true, false}) {
    const auto lawOf = [&](int rows, double step) {
      MotionTable table = tableOf(root, rows, step);
      if (!rates) {
        table.roots_lack = {"velocity", "acceleration", "angular_velocity", "angular_acceleration"};
      }
      return RootLaw(table);
    };
    const RootLaw coarse = lawOf(200, 0.04), fine = lawOf(400, 0.02);
    EXPECT_EQ(fine.hasAccelerations(), rates);
    const Differences one = differences(coarse, root, 200, 0.04);
    const Differences other = differences(fine, root, 400, 0.02);
    const double factor = rates ? 12 : 2;  // of 16 and of 4, and the ends of a spline are worse
    EXPECT_LT(other.turn * factor, one.turn);
    EXPECT_LT(other.acceleration * factor, one.acceleration);
    EXPECT_LT(other.angular_acceleration * factor, one.angular_acceleration);
    EXPECT_LT(other.turn, rates ? 1e-7 : 1e-4);
  }
}

TEST(RootLaw, NeedsPositionsAndOrientations) {
  for (const std::string quantity : {"position", "orientation"}) {
    MotionTable table = tableOf(TumblingRoot(), 10, 0.02);
    table.roots_lack = {quantity};
    try {
      const RootLaw law(table);
      FAIL() << "taken without " << quantity;
    } catch (const MotionError& error) {
      EXPECT_EQ(error.what(), "columns are missing: root." + quantity +
                                  (quantity == "position" ? ".{x,y,z}" : ".{x,y,z,w}"));
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
