#include "tree/exact_products.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference_113.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

#ifndef VWD_HAS_REAL113

TEST(ExactProducts, AreMeasuredIn113Bits) {
  GTEST_SKIP() << "this compiler has no number of 113 bits";
}

#else

// One unit of the last digit is two roundings: the one of the result, and room for the rest.
constexpr long double kOneRounding = std::numeric_limits<long double>::epsilon();

TEST(ExactProducts, RoundOnceWhereTermsCancel) {
  RobotBuilder random(1);
  for (int n = 0; n < 2000; ++n) {
    Vector3l a = random.vector(1), b = random.vector(1);
    a /= 3;  // numbers of all digits
    b /= 7;
    // What is left of the first term is a millionth.
    const long double first = -(a.x() * b.x() + a.y() * b.y() + a.z() * b.z()) * (1 + 1e-6L);
    const Real113 exact = first + dot(toVector113(a), toVector113(b));
    const Real113 error = magnitude(exactDot(first, a, b) - exact);
    EXPECT_LE(error, kOneRounding * magnitude(exact)) << n;
  }
}

TEST(ExactProducts, OrthonormalizedRotationsAreOnesButForTheirRounding) {
  RobotBuilder random(2);
  long double worst_before = 0;
  for (int n = 0; n < 500; ++n) {
    // Entries off by a millionth of a millionth.
    Matrix3l R = random.rotation();
    for (int i = 0; i < 9; ++i) R(i / 3, i % 3) *= 1 + 1e-12L * random.uniform(-1, 1);
    const Matrix3l turned = orthonormalized(R);
    EXPECT_LE((turned - R).norm(), 3e-12L);
    const Matrix113 before = toMatrix113(R);
    worst_before =
        std::max(worst_before, static_cast<long double>(magnitude(dot(before.x, before.x) - 1)));
    const Matrix113 M = toMatrix113(turned);
    for (const Real113 defect : {dot(M.x, M.x) - 1, dot(M.y, M.y) - 1, dot(M.z, M.z) - 1,
                                 dot(M.x, M.y), dot(M.y, M.z), dot(M.z, M.x)}) {
      EXPECT_LE(magnitude(defect), 3 * kOneRounding);
    }
  }
  EXPECT_GE(worst_before, 1e-13L);
}

TEST(ExactProducts, KeepTheZerosOfTheZAxis) {
  const long double y = std::sin(0.7L), z = std::cos(0.7L);
  Matrix3l R;
  R.col(2) << 0, y, z;
  R.col(0) << 1, 1e-19L, -2e-19L;
  R.col(1) << 3e-19L, z, -y;
  EXPECT_EQ(orthonormalized(R)(0, 2), 0);
}

TEST(ExactProducts, LeaveSignedPermutationsAlone) {
  Matrix3l R;
  R << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  EXPECT_EQ(orthonormalized(R), R);
  EXPECT_EQ(exactProduct(R, Matrix3l(R.transpose())), Matrix3l(Matrix3l::Identity()));
}

#endif

}  // namespace
}  // namespace virtual_work_dynamics
