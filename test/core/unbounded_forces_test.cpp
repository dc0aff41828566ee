#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "algebra/cone_program.h"

// Which forces of grasps, pegs and tables have no bound, as statics says.
namespace virtual_work_dynamics {
namespace {

constexpr double kOfCloseCorners =
    1e-9;  // relative; of corners that are the ratio of small differences
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
using Found = ConeProgram::Found;

/// A pad that presses along a normal at a point, with friction.
struct Pad {
  Eigen::Vector3d at, normal;
  double friction;
};

/// The forces of pads that balance a load on the body they press on: x, y along the pad, normal.
class HeldBody {
 public:
  HeldBody(const std::vector<Pad>& pads, const Eigen::Matrix<double, 6, 1>& load)
      : functions_(3 * static_cast<Eigen::Index>(pads.size())),
        program_(functions_, functions_, pads.size()) {
    Eigen::MatrixXd balance(6, functions_);
    for (std::size_t i = 0; i < pads.size(); ++i) {
      const Eigen::Vector3d z = pads[i].normal.normalized(), x = z.unitOrthogonal();
      Eigen::Index column = 3 * static_cast<Eigen::Index>(i);
      for (const Eigen::Vector3d& axis : {x, Eigen::Vector3d(z.cross(x)), z}) {
        balance.col(column).head<3>() = axis;
        balance.col(column++).tail<3>() = pads[i].at.cross(axis);
      }
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(balance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::VectorXd forces = -svd.solve(load);
    const Eigen::Index free = functions_ - svd.rank();
    program_.start(free, functions_);
    for (Eigen::Index i = 0; i < functions_; ++i) {
      program_.function(i)[0] = forces[i];
      program_.function(i).tail(free) = svd.matrixV().row(i).tail(free);
    }
    for (std::size_t i = 0; i < pads.size(); ++i) {
      const Eigen::Index first = 3 * static_cast<Eigen::Index>(i);
      program_.addCone({first + 2, first, 2, pads[i].friction});
    }
    found_ = program_.solve(forces.cwiseAbs().maxCoeff());
  }
  Found found() const { return found_; }
  Eigen::Index functions() const { return functions_; }
  ConeProgram& program() { return program_; }

 private:
  Eigen::Index functions_;
  ConeProgram program_;
  Found found_ = Found::kUnclear;
};

/// Forces that depend on one of them: normal and along of each of two pads in a plane.
struct TwoPads {
  double normal[2][2], along[2][2];  // at zero, and by that force

  ConeProgram program(double friction) const {
    ConeProgram made(1, 4, 2);
    made.start(1, 4);
    for (Eigen::Index pad = 0; pad < 2; ++pad) {
      for (Eigen::Index j = 0; j < 2; ++j) {
        made.function(2 * pad)[j] = along[pad][j];
        made.function(2 * pad + 1)[j] = normal[pad][j];
      }
      made.addCone({2 * pad + 1, 2 * pad, 1, friction});
    }
    return made;
  }
};

Eigen::Matrix<double, 6, 1> weightAt(double weight, double x, double y) {
  Eigen::Matrix<double, 6, 1> load;
  load << 0, 0, -weight, -y * weight, x * weight, 0;
  return load;
}

// Two pads hold a wedge of weight W by its sides, which lean by an angle: each bears half of W, and
// what they squeeze by has a bound as soon as the angle is larger than that of friction.
TEST(UnboundedForces, AWedgeIsSqueezedOutBeyondTheAngleOfFriction) {
  const double mu = 0.5;
  for (const double W : {30.0, 3e4}) {
    for (const double beyond : {-0.3, -1e-3, -1e-6, 1e-6, 1e-3, 0.3}) {
      const double angle = std::atan(mu * (1 + beyond)), c = std::cos(angle), s = std::sin(angle);
      const TwoPads pads{{{W / 2 * s, c}, {W / 2 * s, c}}, {{W / 2 * c, -s}, {W / 2 * c, -s}}};
      ConeProgram program = pads.program(mu);
      ASSERT_EQ(program.solve(W), Found::kFeasible) << beyond;
      EXPECT_EQ(program.recedes(1, -1), beyond < 0) << beyond;
      EXPECT_FALSE(program.recedes(1, 1)) << beyond;
      const double least = W / 2 * (c - mu * s) / (s + mu * c);
      const double most = beyond < 0 ? kNoLimit : W / 2 * (c + mu * s) / (s - mu * c);
      const auto [lower, upper] = program.range(1);
      EXPECT_NEAR(lower, W / 2 * s + c * least, kOfCloseCorners * W) << beyond;
      if (beyond < 0) {
        EXPECT_EQ(upper, kNoLimit) << beyond;
      } else {
        const double expected = W / 2 * s + c * most;
        EXPECT_NEAR(upper, expected, kOfCloseCorners * expected / beyond) << beyond;
      }
    }
  }
}

// A peg in a hole 2 r wide touches it on both sides, L apart, and its weight W acts at c of the
// width outside of it: it jams by any force where L / 2 r is less than friction.
TEST(UnboundedForces, APegJamsWhereItsLengthIsLessThanFriction) {
  const double W = 8, mu = 0.4, c = 2;
  for (const double beyond : {-0.5, -1e-3, -1e-6, 1e-6, 1e-3, 0.2}) {
    const double k = mu * (1 + beyond);
    const TwoPads pads{{{0, 1}, {0, 1}}, {{W * (1 + c), -k}, {-W * c, k}}};
    ConeProgram program = pads.program(mu);
    ASSERT_EQ(program.solve(W), Found::kFeasible) << beyond;
    EXPECT_EQ(program.recedes(1, -1), beyond < 0) << beyond;
    EXPECT_FALSE(program.recedes(3, 1)) << beyond;
    const auto [lower, upper] = program.range(3);
    EXPECT_NEAR(lower, W * (1 + c) / (k + mu), kOfCloseCorners * W) << beyond;
    if (beyond < 0) {
      EXPECT_EQ(upper, kNoLimit) << beyond;
    } else {
      const double expected = W * c / (k - mu);
      EXPECT_NEAR(upper, expected, kOfCloseCorners * expected / beyond) << beyond;
    }
  }
}

// What four legs press with sums up to the weight; with a prop from the ceiling they can bear more,
// and push each other apart by more.
TEST(UnboundedForces, LegsOfATableHaveBoundsUntilAPropPressesOnIt) {
  const double W = 98.1;
  for (const double mu : {0.05, 0.5, 2.0}) {
    std::vector<Pad> pads;
    for (const double x : {-0.3, 0.3}) {
      for (const double y : {-0.2, 0.2}) pads.push_back({{x, y, 0}, {0, 0, 1}, mu});
    }
    HeldBody table(pads, weightAt(W, 0.1, 0.05));
    ASSERT_EQ(table.found(), Found::kFeasible) << mu;
    for (Eigen::Index i = 0; i < table.functions(); ++i) {
      EXPECT_FALSE(table.program().recedes(i, 1)) << mu << ' ' << i;
      EXPECT_FALSE(table.program().recedes(i, -1)) << mu << ' ' << i;
      const auto [lower, upper] = table.program().range(i);
      EXPECT_GT(lower, -(1 + mu) * W) << mu << ' ' << i;
      EXPECT_LT(upper, (1 + mu) * W) << mu << ' ' << i;
    }
    pads.push_back({{0.02, 0.01, 0.7}, {0, 0, -1}, mu});
    HeldBody propped(pads, weightAt(W, 0.1, 0.05));
    ASSERT_EQ(propped.found(), Found::kFeasible) << mu;
    for (Eigen::Index i = 0; i < 12; ++i) {
      EXPECT_EQ(propped.program().recedes(i, 1), i % 3 != 2) << mu << ' ' << i;
      EXPECT_TRUE(propped.program().recedes(i, -1)) << mu << ' ' << i;
    }
  }
}

// Pairs of pads that face each other squeeze by any force, and pads of different pairs push each
// other apart by any force then; nothing pulls.
TEST(UnboundedForces, OpposedPadsSqueezeWithoutBound) {
  for (int trial = 0; trial < 150; ++trial) {
    std::vector<Pad> pads;
    for (int i = 0; i < (trial % 2 == 0 ? 4 : 6); ++i) {
      const double side = i % 2 == 0 ? 1 : -1;
      const int pair = i / 2;
      pads.push_back({{side, 0.5 * pair, 0.3 * (pair % 2)},
                      {-side, 0, 0},
                      0.1 + 0.9 * std::abs(std::sin(trial + i))});
    }
    HeldBody held(pads, weightAt(9.81, 0, 0));
    ASSERT_EQ(held.found(), Found::kFeasible) << trial;
    for (Eigen::Index i = 0; i < held.functions(); ++i) {
      const auto [lower, upper] = held.program().range(i);
      EXPECT_EQ(upper, kNoLimit) << trial << ' ' << i;
      if (i % 3 == 2) {
        EXPECT_GE(lower, -kOfCloseCorners) << trial << ' ' << i;
        EXPECT_LE(lower, 9.81 / 0.1) << trial << ' ' << i;
      } else {
        EXPECT_EQ(lower, -kNoLimit) << trial << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
