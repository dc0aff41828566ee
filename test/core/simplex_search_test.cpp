#include "motion/simplex_search.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace virtual_work_dynamics {
namespace {

using Point = SimplexSearch::Point;
using Function = std::function<double(const Point&)>;

/// Searches to the end. @returns how many values were asked for.
int search(SimplexSearch& simplex, const Function& function, const Point& first, const Point& steps,
           int dimensions, double tolerance, int most) {
  simplex.start(first, steps, dimensions, tolerance, most);
  int values = 0;
  for (; !simplex.finished() && values < 100000; ++values) simplex.tell(function(simplex.asked()));
  return values;
}

constexpr double kTolerance = 1e-6;
// A simplex may end a few of its sizes from the least value, as it sees only its corners.
constexpr double kFewSizes = 5 * kTolerance;

TEST(SimplexSearch, FindsTheLeastValueOfABowlInEachDimension) {
  const Point centre{1.5, -0.25, 3, -7};
  for (int dimensions = 1; dimensions <= SimplexSearch::kMaxDimensions; ++dimensions) {
    const auto count = static_cast<std::size_t>(dimensions);
    const Function bowl = [&](const Point& point) {
      double sum = 0.125;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < count; ++k)
          sum += (i == k ? 2 : 0.5) * (point[i] - centre[i]) * (point[k] - centre[k]);
      return sum;
    };
    SimplexSearch simplex;
    search(simplex, bowl, {0, 0, 0, 0}, {0.5, 0.7, -1, 2}, dimensions, kTolerance, 5000);
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(simplex.best()[i], centre[i], kFewSizes) << dimensions << " dimensions";
    for (std::size_t i = count; i < centre.size(); ++i) EXPECT_EQ(simplex.best()[i], 0);
    EXPECT_EQ(simplex.bestValue(), bowl(simplex.best()));
  }
}

// A curved valley, in which a search has to reflect, expand, contract and turn.
TEST(SimplexSearch, FollowsRosenbrocksValley) {
  const Function valley = [](const Point& point) {
    return 100 * std::pow(point[1] - point[0] * point[0], 2) + std::pow(1 - point[0], 2);
  };
  SimplexSearch simplex;
  const int values = search(simplex, valley, {-1.2, 1}, {0.1, 0.1}, 2, kTolerance, 5000);
  EXPECT_NEAR(simplex.best()[0], 1, 100 * kTolerance);  // along the valley it is flat
  EXPECT_NEAR(simplex.best()[1], 1, 100 * kTolerance);
  EXPECT_LT(values, 400);  // Nelder and Mead report 150 to 300 for like tolerances
}

// Where neither reflection nor contraction is better, all corners go to the best one.
TEST(SimplexSearch, ShrinksWhereNothingElseHelps) {
  const Function pit = [](const Point& point) {
    return point[0] == 0.25 && point[1] == -1 ? -1 : 1 - 0.01 * std::cos(9 * point[0] * point[1]);
  };
  SimplexSearch simplex;
  search(simplex, pit, {0.25, -1}, {1, 1}, 2, 1e-3, 5000);
  EXPECT_EQ(simplex.best()[0], 0.25);
  EXPECT_EQ(simplex.best()[1], -1);
  EXPECT_EQ(simplex.bestValue(), -1);
}

// The points by hand: two corners, then reflection, expansion, contraction outside or inside,
// shrink.
TEST(SimplexSearch, AsksForThePointsOfNelderAndMead) {
  const auto expectAsked = [](const Function& function, double first,
                              const std::vector<double>& points) {
    SimplexSearch simplex;
    simplex.start({first}, {1}, 1, kTolerance, 100);
    for (const double point : points) {
      ASSERT_EQ(simplex.asked()[0], point);
      simplex.tell(function(simplex.asked()));
    }
  };
  const auto around = [](double centre) {
    return [centre](const Point& point) { return std::abs(point[0] - centre); };
  };
  expectAsked(around(0), 1, {1, 2, 0, -1, -1, 0.5, -0.5});
  expectAsked(around(-0.1), 1, {1, 2, 0, -1, -1, -0.5});
  expectAsked(around(-3), 1, {1, 2, 0, -1, -3, -5});
  expectAsked([](const Point& point) { return point[0] == 2 ? 0 : 1; }, 2, {2, 3, 1, 2.5, 2.5});
}

TEST(SimplexSearch, EndsAfterTheMostValuesWithTheBestOne) {
  SimplexSearch simplex;
  double least = std::numeric_limits<double>::infinity();
  const Function slope = [&](const Point& point) {
    const double value = point[0] + point[1] + point[2];
    least = std::min(least, value);
    return value;
  };
  const int values = search(simplex, slope, {5, 5, 5}, {1, 1, 1}, 3, 1e-9, 60);
  EXPECT_GE(values, 60);
  EXPECT_LE(values, 60 + 5);  // it ends between rounds, of at most 2 + 3 values
  EXPECT_EQ(simplex.bestValue(), least);
}

TEST(SimplexSearch, TheLargestNumberIsAValueLikeOthers) {
  const double largest = std::numeric_limits<double>::max();
  const Function wall = [&](const Point& point) {
    return point[0] < 1 ? largest : std::pow(point[0] - 1.5, 2);
  };
  SimplexSearch simplex;
  search(simplex, wall, {0.5}, {1}, 1, kTolerance, 500);
  EXPECT_NEAR(simplex.best()[0], 1.5, kFewSizes);
}

TEST(SimplexSearch, OfNoDimensionAsksForOneValue) {
  SimplexSearch simplex;
  EXPECT_EQ(search(
                simplex, [](const Point&) { return 7; }, {3, 4}, {}, 0, kTolerance, 100),
            1);
  EXPECT_EQ(simplex.bestValue(), 7);
  EXPECT_EQ(simplex.best()[0], 3);
  EXPECT_EQ(simplex.best()[1], 4);
}

TEST(SimplexSearch, StartsAfresh) {
  const auto bowl = [](double centre) {
    return [centre](const Point& point) { return std::pow(point[0] - centre, 2); };
  };
  SimplexSearch used, fresh;
  search(used, bowl(-3), {0, 0, 2}, {1}, 1, kTolerance, 30);
  EXPECT_TRUE(used.finished());
  EXPECT_EQ(search(used, bowl(4), {1}, {1}, 1, kTolerance, 500),
            search(fresh, bowl(4), {1}, {1}, 1, kTolerance, 500));
  EXPECT_EQ(used.best(), fresh.best());
  EXPECT_EQ(used.bestValue(), fresh.bestValue());
}

}  // namespace
}  // namespace virtual_work_dynamics
