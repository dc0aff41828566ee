#include "motion/root_coordinates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "moving_roots.h"
#include "tumbling_roots.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kRounding = 1e-14;

void expectSame(const RootMotion& found, const RootMotion& wanted, double tolerance) {
  EXPECT_LT(angleBetween(found, wanted), tolerance);
  EXPECT_LT((found.position - wanted.position).norm(), tolerance);
  EXPECT_LT((found.velocity - wanted.velocity).norm(), tolerance);
  EXPECT_LT((found.acceleration - wanted.acceleration).norm(), tolerance);
  EXPECT_LT((found.angular_velocity - wanted.angular_velocity).norm(), tolerance);
  EXPECT_LT((found.angular_acceleration - wanted.angular_acceleration).norm(), tolerance);
}

// The matrices of a closed form hold the attitudes; differences of their quaternions, the rates.
TEST(RootCoordinates, AreAPositionAndAQuaternionWithTheirDerivatives) {
  const TumblingRoot root;
  for (double t = 0; t < 10; t += 0.37) {
    const auto quaternion = [&](double step) {
      RootMotion attitude;
      attitude.orientation = root.at(t + step).orientation;
      RootCoordinates near = coordinatesOf(attitude);
      chooseSign(coordinatesOf(root.at(t)), near);
      return Eigen::Vector4d(near.col(0).tail<4>());
    };
    const RootCoordinates found = coordinatesOf(root.at(t));
    // Differences of fourth order: what is left is the fourth power of the step times a fifth or
    // sixth derivative, and rounding over the step or its square.
    const double h = 1e-3, g = 2e-3;
    const Eigen::Vector4d first =
        (8 * (quaternion(h) - quaternion(-h)) - (quaternion(2 * h) - quaternion(-2 * h))) /
        (12 * h);
    const Eigen::Vector4d second = (16 * (quaternion(g) + quaternion(-g)) - 30 * quaternion(0) -
                                    (quaternion(2 * g) + quaternion(-2 * g))) /
                                   (12 * g * g);
    EXPECT_LT((found.col(1).tail<4>() - first).norm(), 2e-11);
    EXPECT_LT((found.col(2).tail<4>() - second).norm(), 2e-9);
    EXPECT_EQ(found.col(0).head<3>(), root.at(t).position);
    EXPECT_EQ(found.col(1).head<3>(), root.at(t).velocity);
    EXPECT_EQ(found.col(2).head<3>(), root.at(t).acceleration);
  }
}

TEST(RootCoordinates, MeanTheMotionThatTheyAreOf) {
  std::mt19937 generator(3);
  for (int i = 0; i < 1000; ++i) {
    const RootMotion root = randomRootMotion(generator);
    expectSame(rootMotionOf(coordinatesOf(root)), root, 10 * kRounding);
  }
}

// A quaternion that an estimator gives is not of unit length, and its length varies: q(t) s(t).
TEST(RootCoordinates, KnowNoLength) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const RootMotion root = randomRootMotion(generator);
    RootCoordinates coordinates = coordinatesOf(root);
    const double s = (i % 2 == 0 ? 1 : -1) * (1 + 0.1 * part(generator));
    const double sd = part(generator), sdd = 5 * part(generator);
    const Eigen::Matrix<double, 4, 3> q = coordinates.bottomRows<4>();
    coordinates.bottomRows<4>().col(0) = s * q.col(0);
    coordinates.bottomRows<4>().col(1) = s * q.col(1) + sd * q.col(0);
    coordinates.bottomRows<4>().col(2) = s * q.col(2) + 2 * sd * q.col(1) + sdd * q.col(0);
    expectSame(rootMotionOf(coordinates), root, 30 * kRounding);
  }
}

// At rest in axes of the inertial frame, and turned about one of these, no component is near 1.
TEST(RootCoordinates, ShowTurnsWhereRobotsRest) {
  for (int axis = 0; axis < 3; ++axis) {
    for (double angle = 0; angle < 6.3; angle += 0.1) {
      RootMotion turned;
      turned.orientation = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis));
      EXPECT_LT(coordinatesOf(turned).col(0).tail<4>().cwiseAbs().maxCoeff(), 0.71);
    }
  }
}

TEST(RootCoordinates, HaveTheSignOfThoseBefore) {
  std::mt19937 generator(5);
  const RootCoordinates before = coordinatesOf(randomRootMotion(generator));
  RootCoordinates same = before;
  chooseSign(before, same);
  EXPECT_EQ(same, before);
  same.bottomRows<4>() *= -1;
  chooseSign(before, same);
  EXPECT_EQ(same, before);
}

}  // namespace
}  // namespace virtual_work_dynamics
