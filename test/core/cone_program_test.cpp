#include "algebra/cone_program.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace virtual_work_dynamics {
namespace {

constexpr double kSameCorner = 1e-9;  // relative; corners are solved for anew by the oracle
using Found = ConeProgram::Found;

struct Planes {
  Eigen::MatrixXd A;  // A y + b >= 0
  Eigen::VectorXd b;
};

// The least of c y over all corners, by solving for each n planes; +infinity without a corner.
double leastOfCorners(const Planes& planes, const Eigen::VectorXd& c) {
  const Eigen::Index n = c.size(), m = planes.b.size();
  double least = std::numeric_limits<double>::infinity();
  std::vector<bool> chosen(static_cast<std::size_t>(m), false);
  std::fill_n(chosen.begin(), n, true);
  do {
    Eigen::MatrixXd A(n, n);
    Eigen::VectorXd b(n);
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < m; ++i) {
      if (!chosen[static_cast<std::size_t>(i)]) continue;
      A.row(row) = planes.A.row(i);
      b[row++] = planes.b[i];
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    if (lu.rcond() < 1e-10) continue;
    const Eigen::VectorXd y = lu.solve(-b);
    if ((planes.A * y + planes.b).minCoeff() < -1e-9) continue;
    least = std::min(least, c.dot(y));
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return least;
}

// Normals in a box, and friction along one line: all corners are enumerated.
TEST(ConeProgram, FindsTheBestOfAllCorners) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  int feasible = 0, infeasible = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Index n = 2 + trial % 3;
    const Eigen::Index normals = n + trial % 2, boxes = 2 * n;
    const Eigen::Index functions = 2 * normals + boxes + 1;
    ConeProgram program(n, functions, static_cast<std::size_t>(normals + boxes));
    program.start(n, functions);
    Planes planes{Eigen::MatrixXd(3 * normals + boxes, n), Eigen::VectorXd(3 * normals + boxes)};
    Eigen::Index row = 0;
    const auto plane = [&](const Eigen::VectorXd& f) {
      planes.b[row] = f[0];
      planes.A.row(row++) = f.tail(n).transpose();
    };
    for (Eigen::Index i = 0; i < normals; ++i) {
      const double friction = 0.2 + 0.3 * static_cast<double>(i % 3);
      for (Eigen::Index j = 0; j <= n; ++j) {
        program.function(2 * i)[j] = number(random);
        program.function(2 * i + 1)[j] = number(random) + (j == 0 ? 0.7 : 0);
      }
      const Eigen::VectorXd along = program.function(2 * i).transpose();
      const Eigen::VectorXd normal = program.function(2 * i + 1).transpose();
      program.addCone({2 * i + 1, 2 * i, 1, friction});
      plane(normal);
      plane(friction * normal - along);
      plane(friction * normal + along);
    }
    for (Eigen::Index i = 0; i < boxes; ++i) {
      const Eigen::Index at = 2 * normals + i;
      program.function(at)[0] = 3;
      program.function(at)[1 + i / 2] = i % 2 == 0 ? 1 : -1;
      program.addCone({at, 0, 0, 0});
      plane(program.function(at).transpose());
    }
    Eigen::VectorXd c(n);
    for (Eigen::Index j = 0; j < n; ++j)
      c[j] = program.function(functions - 1)[1 + j] = number(random);
    const Found found = program.solve(1);
    const double least = leastOfCorners(planes, c);
    ASSERT_NE(found, Found::kUnclear) << trial;
    ASSERT_EQ(found == Found::kFeasible, std::isfinite(least)) << trial;
    ++(found == Found::kFeasible ? feasible : infeasible);
    if (found != Found::kFeasible) continue;
    const auto [lower, upper] = program.range(functions - 1);
    EXPECT_NEAR(lower, least, kSameCorner) << trial;
    EXPECT_NEAR(upper, -leastOfCorners(planes, -c), kSameCorner) << trial;
  }
  EXPECT_GT(feasible, 15);
  EXPECT_GT(infeasible, 5);
}

// One contact that presses with 10: along the plane no direction is bounded more narrowly than the
// cone does, nor wider than its pyramid is.
TEST(ConeProgram, PyramidsAreJustWiderThanCones) {
  const double mu = 0.3, normal = 10;
  for (int degree = 0; degree < 360; degree += 7) {
    ConeProgram program(2, 4, 1);
    program.start(2, 4);
    program.function(0)[1] = program.function(1)[2] = 1;
    program.function(2)[0] = normal;
    program.function(3)[1] = std::cos(degree * M_PI / 180);
    program.function(3)[2] = std::sin(degree * M_PI / 180);
    program.addCone({2, 0, 2, mu});
    ASSERT_EQ(program.solve(normal), Found::kFeasible);
    const auto [lower, upper] = program.range(3);
    for (const double most : {upper, -lower}) {
      EXPECT_GE(most, mu * normal * (1 - 1e-12)) << degree;
      EXPECT_LE(most, mu * normal * 1.0001) << degree;
    }
  }
}

// Two pads press against each other: pushed outwards, nothing limits them, and pulled apart, no
// force holds them.
TEST(ConeProgram, WhatNothingBoundsIsInfinite) {
  for (const double pull : {0.0, 1.0}) {
    ConeProgram program(2, 3, 2);
    program.start(2, 3);
    program.function(0)[1] = 1;  // one pad
    program.function(1)[0] = -pull;
    program.function(1)[1] = pull == 0 ? 1 : -1;  // the other
    program.function(2)[2] = 1;                   // what neither has to do with
    program.addCone({0, 0, 0, 0});
    program.addCone({1, 0, 0, 0});
    ASSERT_EQ(program.solve(1), pull == 0 ? Found::kFeasible : Found::kInfeasible);
    if (pull != 0) continue;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(program.range(0), std::make_pair(0.0, kInfinity));
    EXPECT_EQ(program.range(2), std::make_pair(-kInfinity, kInfinity));
  }
}

// Pads around a peg, of which only some can squeeze by any force: after a function that is
// unbounded comes one that is bounded. Directions turn about a ray along which all pads press
// harder.
TEST(ConeProgram, BoundsAreFoundAfterAFunctionWithoutOne) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1, 1);
  constexpr Eigen::Index kVariables = 9, kPads = 5;
  int bounded = 0, unbounded = 0;
  for (int trial = 0; trial < 40; ++trial) {
    ConeProgram first(kVariables, 3 * kPads, kPads);
    first.start(kVariables, 3 * kPads);
    for (Eigen::Index i = 0; i < 3 * kPads; ++i) {
      for (Eigen::Index j = 0; j <= kVariables; ++j) first.function(i)[j] = number(random);
    }
    for (Eigen::Index i = 0; i < kPads; ++i) {
      first.function(3 * i + 2)[0] = 1;
      first.addCone({3 * i + 2, 3 * i, 2, i % 2 == 0 ? 0.01 : 0.5});
    }
    if (first.solve(1) != Found::kFeasible) continue;
    ConeProgram again = first;
    for (Eigen::Index i = 0; i < 3 * kPads; ++i) {
      const auto [lower, upper] = first.range(i);
      ConeProgram fresh = again;
      const auto [fresh_lower, fresh_upper] = fresh.range(i);
      for (const auto& [found, expected] :
           {std::make_pair(lower, fresh_lower), std::make_pair(upper, fresh_upper)}) {
        if (std::isinf(expected)) {
          EXPECT_EQ(found, expected) << trial << " " << i;
          ++unbounded;
        } else {
          EXPECT_NEAR(found, expected, kSameCorner * std::max(1.0, std::abs(expected)))
              << trial << " " << i;
          ++bounded;
        }
      }
      EXPECT_TRUE(i % 3 != 2 || lower >= -kSameCorner) << trial << " " << i;
    }
  }
  EXPECT_GT(bounded, 100);
  EXPECT_GT(unbounded, 15);
}

// A second pad that presses only where the first one does with all it has: there is such a force,
// and that its effect is small makes nobody certain that there is none.
TEST(ConeProgram, WhatRoundingErrorsDecideIsNotInfeasible) {
  ConeProgram program(1, 2, 2);
  program.start(1, 2);
  program.function(0)[1] = 1;
  program.function(1)[0] = -5e-10;
  program.function(1)[1] = 5e-10;
  program.addCone({0, 0, 0, 0});
  program.addCone({1, 0, 0, 0});
  EXPECT_NE(program.solve(1), Found::kInfeasible);
}

}  // namespace
}  // namespace virtual_work_dynamics
