#include "algebra/multifrontal_qr.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <random>
#include <set>

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kAnyCondition = 1e12;
// Rounding of some hundred reflections of vectors of order one.
constexpr double kRounding = 300 * kEps;
// The estimate is a lower bound except for rounding, and at most this factor below the condition
// number from singular values.
constexpr double kMissed = 10;

// Blocks like those of loops: rows of several columns, repeated rows among them, and rows of one.
class RandomBlocks {
 public:
  explicit RandomBlocks(unsigned seed) : random_(seed) {}

  int number(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  double real() { return std::normal_distribution<double>()(random_); }

  std::vector<RowBlock> blocks(int columns) {
    std::vector<RowBlock> blocks;
    for (int first = 0; first < columns; first += number(1, 2)) {
      std::set<int> some{first};
      for (int i = number(0, 3); i > 0; --i) {
        some.insert(std::min(columns - 1, first + number(0, number(0, 9) == 0 ? columns : 4)));
      }
      RowBlock block{number(1, 6), {some.begin(), some.end()}, {}};
      for (int row = 0; row < block.rows; ++row) {
        if (number(0, 3) == 0) block.zeros.push_back(row);
      }
      blocks.push_back(block);
    }
    for (int column = 0; column < columns; ++column) {
      if (number(0, 2) == 0) blocks.push_back({1, {column}, {}});
    }
    std::shuffle(blocks.begin(), blocks.end(), random_);
    return blocks;
  }

  // One block of all columns, and rows of one, that together are a front of one chunk.
  std::vector<RowBlock> smallBlocks(int columns) {
    RowBlock block{number(columns, kRowChunk + 1), {}, {}};
    for (int column = 0; column < columns; ++column) block.columns.push_back(column);
    if (block.rows > kRowChunk) block.zeros.push_back(number(0, kRowChunk));
    std::vector<RowBlock> blocks{block};
    if (block.rows < kRowChunk) blocks.push_back({1, {number(0, columns - 1)}, {}});
    return blocks;
  }

  // Fills entries with a rank that can be less than the number of rows.
  void fill(Eigen::MatrixXd& entries, const std::vector<int>& zeros) {
    const auto any = [&]() { return real(); };
    const Eigen::Index rank = number(1, static_cast<int>(entries.rows()));
    const Eigen::MatrixXd left = Eigen::MatrixXd::NullaryExpr(entries.rows(), rank, any);
    entries = left * Eigen::MatrixXd::NullaryExpr(rank, entries.cols(), any);
    for (const int row : zeros) entries.row(row).setZero();
  }

 private:
  std::mt19937 random_;
};

Eigen::MatrixXd dense(const MultifrontalQr& qr, const std::vector<bool>& present) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(qr.rows(), qr.columns());
  for (std::size_t b = 0; b < qr.blocks(); ++b) {
    const Eigen::MatrixXd& entries = qr.entriesOf(b);
    for (Eigen::Index j = 0; j < entries.cols(); ++j) {
      const int column = qr.columnsOf(b)[static_cast<std::size_t>(j)];
      if (!present[static_cast<std::size_t>(column)]) continue;
      M.col(column).segment(qr.firstOf(b), entries.rows()) = entries.col(j);
    }
  }
  return M;
}

struct Case {
  MultifrontalQr& qr;
  const Eigen::MatrixXd& M;  // absent columns are zero
  const std::vector<bool>& present;
  RandomBlocks& random;
  double condition;  // largest over least singular value
};

// Calls check(Case) for every random matrix of full column rank.
template <typename Check>
int forRandomMatrices(Check&& check) {
  RandomBlocks random(11);
  int sound = 0;
  for (int round = 0; round < 400; ++round) {
    const int columns = random.number(1, 25);
    const std::vector<RowBlock> blocks = random.blocks(columns);
    MultifrontalQr qr(blocks, columns);
    for (int filling = 0; filling < 3; ++filling) {
      for (std::size_t b = 0; b < qr.blocks(); ++b) {
        random.fill(qr.entriesOf(b), blocks[b].zeros);
      }
      std::vector<bool> present;
      for (int j = 0; j < columns; ++j) present.push_back(filling == 0 || random.number(0, 2) > 0);
      qr.setPresent(present);
      EXPECT_LE(qr.layout().usedNumbers(), qr.layout().numbers());
      EXPECT_LE(qr.layout().usedStairs(), qr.layout().stairs());
      const Eigen::MatrixXd M = dense(qr, present);
      const Eigen::Index count = std::count(present.begin(), present.end(), true);
      const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(M).singularValues();
      const bool full = count <= M.rows() && (count == 0 || values[count - 1] > 1e-9 * values[0]);
      EXPECT_EQ(qr.factorize(kAnyCondition), full) << "round " << round;
      if (!full || count == 0) continue;
      ++sound;
      check(Case{qr, M, present, random, values[0] / values[count - 1]});
    }
  }
  return sound;
}

// Legs of three rows, each with two columns of its own and all others.
std::vector<RowBlock> legs(int count, int others) {
  std::vector<RowBlock> blocks;
  for (int leg = 0; leg < count; ++leg) {
    RowBlock block{3, {2 * leg, 2 * leg + 1}, {}};
    for (int i = 0; i < others; ++i) block.columns.push_back(2 * count + i);
    blocks.push_back(block);
  }
  return blocks;
}

TEST(MultifrontalQr, FrontsHaveRoomForTheRowsThatTheyAreHandedAndNoMore) {
  FrontLayout layout(legs(5, 5), 15);
  const auto lastRows = [&] {
    return layout.view().fronts[layout.view().front_count - 1].most_rows;
  };
  EXPECT_EQ(lastRows(), 2 * kRowChunk);  // a row of each leg
  std::vector<bool> present(15, true);
  for (std::size_t own = 0; own < 10; ++own) present[own] = false;
  layout.setPresent(present);
  EXPECT_EQ(lastRows(), 4 * kRowChunk);  // all three
}

TEST(MultifrontalQr, TellsFullColumnRankAndEstimatesTheCondition) {
  const int sound = forRandomMatrices([](const Case& tried) {
    EXPECT_LE(tried.qr.condition(), tried.condition * (1 + 1e-6));
    EXPECT_GE(tried.qr.condition() * kMissed, tried.condition / std::sqrt(tried.M.cols()));
  });
  EXPECT_GT(sound, 300);
}

TEST(MultifrontalQr, SolutionOfTheTransposeIsTheOneOfLeastNorm) {
  forRandomMatrices([](const Case& tried) {
    Eigen::VectorXd b(tried.M.cols()), x(tried.M.rows());
    for (Eigen::Index j = 0; j < b.size(); ++j) b[j] = tried.random.real();
    for (Eigen::Index j = 0; j < b.size(); ++j) b[j] *= tried.present[std::size_t(j)];
    tried.qr.leastNorm(b.data(), x.data());
    const Eigen::VectorXd expected = tried.M.transpose().completeOrthogonalDecomposition().solve(b);
    EXPECT_LE((x - expected).norm(), kRounding * tried.condition * expected.norm());
  });
}

TEST(MultifrontalQr, SolvesLeastSquares) {
  forRandomMatrices([](const Case& tried) {
    Eigen::VectorXd r(tried.M.rows()), u(tried.M.cols());
    for (Eigen::Index i = 0; i < r.size(); ++i) r[i] = tried.random.real();
    u.setZero();
    tried.qr.leastSquares(r.data(), u.data());
    const Eigen::VectorXd expected = tried.M.completeOrthogonalDecomposition().solve(r);
    const double largest = tried.condition * (expected.norm() + r.norm() / tried.M.norm());
    EXPECT_LE((u - expected).norm(), kRounding * tried.condition * largest);
    for (Eigen::Index j = 0; j < u.size(); ++j) {
      EXPECT_TRUE(tried.present[std::size_t(j)] || u[j] == 0) << j;
    }
  });
}

TEST(MultifrontalQr, NullVectorsAreOrthonormalAndComplete) {
  forRandomMatrices([](const Case& tried) {
    MultifrontalQr& qr = tried.qr;
    const Eigen::Index present = std::count(tried.present.begin(), tried.present.end(), true);
    ASSERT_EQ(static_cast<Eigen::Index>(qr.nullity()), qr.rows() - present);
    Eigen::MatrixXd N(qr.rows(), qr.rows() - present);
    Eigen::VectorXd x(qr.rows());
    for (std::size_t i = 0; i < qr.nullity(); ++i) {
      x.setConstant(std::numeric_limits<double>::quiet_NaN());
      qr.nullVector(i, x);
      auto column = N.col(static_cast<Eigen::Index>(i));
      column.setZero();
      for (const std::size_t b : qr.touched()) {
        const Eigen::Index rows = qr.firstOf(b + 1) - qr.firstOf(b);
        column.segment(qr.firstOf(b), rows) = x.segment(qr.firstOf(b), rows);
      }
    }
    EXPECT_LE((N.transpose() * N - Eigen::MatrixXd::Identity(N.cols(), N.cols())).norm(),
              kRounding);
    EXPECT_LE((tried.M.transpose() * N).norm(), kRounding * tried.M.norm());
    for (Eigen::Index row = 0; row < qr.rows(); ++row) {
      EXPECT_NEAR(qr.nullSquare(row), N.row(row).squaredNorm(), kRounding);
    }
  });
}

// Rows that say the same are found in their block, not at the end of the chain.
TEST(MultifrontalQr, NullVectorsOfABlockStayInIt) {
  constexpr int kLoops = 20;
  std::vector<RowBlock> blocks{{1, {0}, {}}};
  for (int i = 0; i < kLoops; ++i) blocks.push_back({5, {2 * i, 2 * i + 1, 2 * i + 2}, {}});
  MultifrontalQr qr(blocks, 2 * kLoops + 1);
  RandomBlocks random(3);
  qr.entriesOf(0)(0, 0) = 1;
  for (std::size_t b = 1; b < qr.blocks(); ++b) {
    qr.entriesOf(b).setZero();
    for (int i : {0, 1}) {
      for (int j : {0, 1, 2}) qr.entriesOf(b)(i, j) = random.real();
    }
  }
  ASSERT_TRUE(qr.factorize(kAnyCondition));
  ASSERT_EQ(qr.nullity(), 3u * kLoops);
  Eigen::VectorXd x(qr.rows());
  for (std::size_t i = 0; i < qr.nullity(); ++i) {
    qr.nullVector(i, x);
    EXPECT_EQ(std::count_if(qr.touched().begin(), qr.touched().end(),
                            [](std::size_t block) { return block > 0; }),
              1);
  }
}

// Matrices side by side: what is found of each is, to the last bit, what is found of it alone. Of
// those of one small front, too, which single matrices have loops of constant length for.
TEST(MultifrontalQr, PacksAgreeWithSingleMatrices) {
  const FrontKernel& kernel = frontKernelFor(chosenInstructionSet());
  const std::size_t width = static_cast<std::size_t>(kernel.width);
  RandomBlocks random(5);
  int compared = 0, compared_small = 0;
  for (int round = 0; round < 200; ++round) {
    const bool small = round >= 100;
    const int columns = random.number(1, small ? 4 : 12);
    const std::vector<RowBlock> blocks =
        small && columns > 1 ? random.smallBlocks(columns) : random.blocks(columns);
    MultifrontalQr qr(blocks, columns);
    const FrontLayout& layout = qr.layout();
    std::vector<std::vector<double>> packed(blocks.size());
    Eigen::MatrixXd right(columns, kernel.width), expected(qr.rows(), kernel.width);
    Eigen::MatrixXd left =
        Eigen::MatrixXd::NullaryExpr(qr.rows(), kernel.width, [&] { return random.real(); });
    Eigen::MatrixXd squares(columns, kernel.width);
    std::vector<double> conditions;
    bool all = true;
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        Eigen::MatrixXd& entries = qr.entriesOf(b);
        entries = Eigen::MatrixXd::NullaryExpr(entries.rows(), entries.cols(),
                                               [&] { return random.real(); });
        for (const int row : blocks[b].zeros) entries.row(row).setZero();
        packed[b].resize(static_cast<std::size_t>(entries.size()) * width);
        for (Eigen::Index k = 0; k < entries.size(); ++k) {
          packed[b][static_cast<std::size_t>(k) * width + i] = entries.data()[k];
        }
      }
      const auto at = static_cast<Eigen::Index>(i);
      for (int j = 0; j < columns; ++j) right(j, at) = random.real();
      all = qr.factorize(kAnyCondition) && all;
      conditions.push_back(qr.condition());
      if (!all) continue;
      qr.leastNorm(right.col(at).data(), expected.col(at).data());
      qr.leastSquares(left.col(at).data(), squares.col(at).data());
    }
    if (!all) continue;
    std::vector<const double*> entries;
    for (const std::vector<double>& block : packed) entries.push_back(block.data());
    const AlignedMemory numbers(layout.numbers() * width * sizeof(double));
    std::vector<FrontState> states(layout.fronts().size());
    std::vector<int> stairs(layout.stairs());
    const FrontsMemory memory{static_cast<double*>(numbers.get()), states.data(), stairs.data()};
    std::vector<double> found(width), x(layout.rows() * width);
    ASSERT_EQ(kernel.pack.factorize(layout.view(), entries.data(), 0, memory, found.data()),
              Factorized::kWhole);
    EXPECT_EQ(found, conditions);
    const Eigen::MatrixXd b = right.transpose();
    kernel.pack.leastNorm(layout.view(), memory, b.data(), x.data());
    for (Eigen::Index row = 0; row < qr.rows(); ++row) {
      for (std::size_t i = 0; i < width; ++i) {
        EXPECT_EQ(x[static_cast<std::size_t>(row) * width + i],
                  expected(row, static_cast<Eigen::Index>(i)));
      }
    }
    const Eigen::MatrixXd r = left.transpose();
    Eigen::MatrixXd u(kernel.width, columns);
    kernel.pack.leastSquares(layout.view(), memory, r.data(), u.data());
    EXPECT_EQ(u.transpose(), squares);
    ++(small ? compared_small : compared);
  }
  EXPECT_GT(compared, 20);
  EXPECT_GT(compared_small, 60);
}

TEST(MultifrontalQr, DependentColumnsAreNoFactorization) {
  MultifrontalQr qr({{2, {0, 1}, {}}, {2, {1, 2}, {}}}, 3);
  qr.entriesOf(0) << 1, 2, 2, 4;
  qr.entriesOf(1) << 1, 3, 2, 7;
  EXPECT_TRUE(qr.factorize(kAnyCondition));
  qr.entriesOf(1) << 1, 3, 2, 6;
  EXPECT_FALSE(qr.factorize(kAnyCondition));
  qr.entriesOf(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(qr.factorize(kAnyCondition));
  qr.entriesOf(1) << 1, 3, 2, 6 + 1e-6;
  EXPECT_TRUE(qr.factorize(kAnyCondition));
  EXPECT_FALSE(qr.factorize(1e4));
}

}  // namespace
}  // namespace virtual_work_dynamics
