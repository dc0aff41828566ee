#include "algebra/rank_factorization.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <random>

namespace virtual_work_dynamics {
namespace {

constexpr double kRankTolerance = 1e-10;
// Orthonormality: a few eps for each of up to 20 reflections.
constexpr double kOrthonormal = 1e-14;
// Solutions of random systems, conditions up to 1e3 or so.
constexpr double kSolution = 1e-11;

class RandomMatrices {
 public:
  explicit RandomMatrices(unsigned seed) : generator_(seed) {}
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&]() { return normal(generator_); });
  }
  Eigen::MatrixXd ofRank(Eigen::Index rows, Eigen::Index columns, Eigen::Index rank) {
    const Eigen::MatrixXd left = matrix(rows, rank);
    return left * matrix(rank, columns);
  }

 private:
  std::mt19937 generator_;
};

template <typename Check>
void forRandomMatrices(Check&& check) {
  RandomMatrices random(7);
  RankFactorization factorization(12, 15);
  for (const auto& size : {std::pair<int, int>{1, 1}, {3, 8}, {12, 15}, {12, 5}, {6, 6}, {2, 15}}) {
    for (int rank = 0; rank <= std::min(size.first, size.second); ++rank) {
      const Eigen::MatrixXd G = random.ofRank(size.first, size.second, rank);
      factorization.factorize(G, kRankTolerance);
      check(G, rank, factorization, random);
    }
  }
}

TEST(RankFactorization, FindsTheRankThatTheSingularValuesHave) {
  forRandomMatrices(
      [](const Eigen::MatrixXd& G, int rank, const RankFactorization& found, RandomMatrices&) {
        Eigen::JacobiSVD<Eigen::MatrixXd> svd(G);
        svd.setThreshold(kRankTolerance);
        EXPECT_EQ(svd.rank(), rank);
        EXPECT_EQ(found.rank(), rank);
        EXPECT_EQ(found.redundancy(), G.cols() - rank);
        if (rank > 0) {
          const auto& values = svd.singularValues();
          EXPECT_LE(found.condition(), values[0] / values[rank - 1] * 1.0001 * std::sqrt(G.size()));
          EXPECT_GE(found.condition() * std::sqrt(G.size()) * 4, values[0] / values[rank - 1]);
        }
        if (rank > 0 && rank < std::min(G.rows(), G.cols())) {
          EXPECT_GT(found.gap(), 1e10);
        } else {
          EXPECT_TRUE(std::isinf(found.gap()));
        }
      });
}

TEST(RankFactorization, NullAndRowSpaceAreOrthonormalAndComplete) {
  forRandomMatrices([](const Eigen::MatrixXd& G, int, const RankFactorization& found,
                       RandomMatrices&) {
    Eigen::MatrixXd Q(G.cols(), G.cols());
    Q << found.rowSpace(), found.nullSpace();
    EXPECT_LE(
        (Q.transpose() * Q - Eigen::MatrixXd::Identity(G.cols(), G.cols())).cwiseAbs().maxCoeff(),
        kOrthonormal);
    if (found.redundancy() > 0) {
      EXPECT_LE((G * found.nullSpace()).norm(), kOrthonormal * 20 * std::max(1.0, G.norm()));
    }
  });
}

TEST(RankFactorization, SolutionIsTheOneOfLeastNorm) {
  forRandomMatrices(
      [](const Eigen::MatrixXd& G, int, const RankFactorization& found, RandomMatrices& random) {
        const Eigen::VectorXd b = G * random.matrix(G.cols(), 1);
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> expected;
        expected.setThreshold(kRankTolerance);
        expected.compute(G);
        Eigen::VectorXd x(G.cols());
        found.solve(b, x);
        const Eigen::VectorXd least = expected.solve(b);
        EXPECT_LE((x - least).norm(), kSolution * std::max(1.0, least.norm()));
      });
}

// One triangle tells both null spaces, so that their dimensions always agree.
TEST(RankFactorization, SolvesTheTransposeAndFindsItsNullSpace) {
  forRandomMatrices([](const Eigen::MatrixXd& G, int rank, const RankFactorization& found,
                       RandomMatrices& random) {
    const Eigen::VectorXd load = G.transpose() * random.matrix(G.rows(), 1);
    Eigen::VectorXd y(G.rows());
    found.solveTransposed(load, y);
    EXPECT_LE((G.transpose() * y - load).norm(), kSolution * std::max(1.0, load.norm()));
    EXPECT_LE((y.array() != 0).count(), rank);
    Eigen::MatrixXd null(G.rows(), G.rows() - rank);
    for (Eigen::Index i = 0; i < null.cols(); ++i) {
      found.leftNullVector(i, y);
      null.col(i) = y;
    }
    EXPECT_LE((G.transpose() * null).norm(), kSolution * std::max(1.0, G.norm()) * null.norm());
    if (null.cols() == 0) return;
    EXPECT_EQ(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(null).rank(), null.cols());
  });
}

TEST(RankFactorization, RowsBelowTheToleranceDoNotCount) {
  Eigen::MatrixXd G(2, 3);
  G << 1, 0, 0, 1, 1e-9, 0;
  RankFactorization factorization(2, 3);
  factorization.factorize(G, 1e-10);
  EXPECT_EQ(factorization.rank(), 2);
  factorization.factorize(G, 1e-8);
  EXPECT_EQ(factorization.rank(), 1);
  EXPECT_NEAR(factorization.gap(), 1e9, 1e3);
  factorization.factorize(G, 0, 2);
  EXPECT_EQ(factorization.rank(), 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
