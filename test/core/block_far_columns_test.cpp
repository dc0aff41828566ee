#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "plain_results.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/urdf_reader.h"

// Long blocks of many columns, which are copied through columns close together. Rows of samples
// never are.

namespace virtual_work_dynamics {
namespace {

// A tree of joints of all types that floats on a root that moves, with a wrench on a link.
struct FloatingTree {
  RandomRobot random{4, 12};
  Mechanism mechanism{readUrdf(urdf())};
  Scene scene;

  FloatingTree() {
    scene.root_moves = true;
    scene.applied_wrenches.resize(1);
    scene.applied_wrenches[0].link = "link_11";
    scene.applied_wrenches[0].axes = Axes::kRoot;
    scene.applied_wrenches[0].force << 10, 20, -30;
    scene.applied_wrenches[0].torque << 1, -2, 3;
  }

  std::string urdf() const {
    std::string text = random.urdf();
    return text.insert(text.find('\n'),
                       "<link name='world'/><joint name='float' type='floating'>"
                       "<parent link='world'/><child link='link_0'/></joint>");
  }
};

/// Arrays of a block by columns and by rows: `numbers` of each sample.
template <typename Real>
struct BothLayouts {
  BothLayouts(std::size_t count, std::size_t width)
      : samples(count), numbers(width), columns(count * width), rows(count * width) {}

  void fill(std::mt19937& generator) {
    std::normal_distribution<double> normal;
    for (std::size_t n = 0; n < samples; ++n) {
      for (std::size_t c = 0; c < numbers; ++c) {
        columns[c * samples + n] = rows[n * numbers + c] = static_cast<Real>(normal(generator));
      }
    }
  }
  std::size_t differences() const {
    std::size_t count = 0;
    for (std::size_t n = 0; n < samples; ++n) {
      for (std::size_t c = 0; c < numbers; ++c) {
        const Real &a = columns[c * samples + n], &b = rows[n * numbers + c];
        if (std::memcmp(&a, &b, sizeof(Real)) != 0) ++count;
      }
    }
    return count;
  }

  std::size_t samples, numbers;
  std::vector<Real> columns, rows;
};

template <typename Real>
class LongBlock {
 public:
  LongBlock(const InverseDynamics& dynamics, std::size_t samples)
      : LongBlock(dynamics, samples, 6 * dynamics.request().root_axes.size()) {}

  MotionBlock<Real> in(std::vector<Real> BothLayouts<Real>::*layout) {
    return {in_[0].samples,          (in_[0].*layout).data(), (in_[1].*layout).data(),
            (in_[2].*layout).data(), (in_[3].*layout).data(), (in_[4].*layout).data()};
  }
  ResultBlock<Real> out(std::vector<Real> BothLayouts<Real>::*layout) {
    return {(out_[0].*layout).data(), (out_[1].*layout).data(), (out_[2].*layout).data(),
            (out_[3].*layout).data(), (out_[4].*layout).data()};
  }
  std::vector<std::size_t> differences() const {
    std::vector<std::size_t> counts;
    for (const auto& each : out_) counts.push_back(each.differences());
    return counts;
  }

 private:
  LongBlock(const InverseDynamics& dynamics, std::size_t samples, std::size_t wrenches)
      : LongBlock(samples, static_cast<std::size_t>(dynamics.coordinates()),
                  4 * dynamics.orientations(), wrenches) {}
  LongBlock(std::size_t samples, std::size_t joints, std::size_t turns, std::size_t wrenches)
      : in_{{samples, joints},
            {samples, joints},
            {samples, joints},
            {samples, 9},
            {samples, turns}},
        out_{{samples, joints},
             {samples, wrenches},
             {samples, wrenches},
             {samples, 2 * wrenches},
             {samples, wrenches}} {
    std::mt19937 generator(5);
    for (auto& each : in_) each.fill(generator);
  }

  std::vector<BothLayouts<Real>> in_, out_;
};

template <typename Real>
void expectColumnsLikeRows(std::size_t samples, int threads) {
  const FloatingTree tree;
  ASSERT_GT(tree.mechanism.orientations(), 0u);
  const Request request = requestAll(tree.mechanism);
  std::vector<Load> loads(samples, Load(tree.scene));
  for (std::size_t n = 0; n < samples; ++n) loads[n].wrenches[0].force[1] = static_cast<double>(n);
  for (const InstructionSet set : supportedInstructionSets()) {
    const InverseDynamics dynamics(tree.mechanism, tree.scene, request, set);
    BlockInverseDynamics<Real> block(dynamics, threads, set);
    LongBlock<Real> arrays(dynamics, samples);
    const auto columns = &BothLayouts<Real>::columns, rows = &BothLayouts<Real>::rows;
    block.compute(BlockLayout::kStructureOfArrays, arrays.in(columns), loads.data(),
                  arrays.out(columns));
    EXPECT_NE(arrays.differences()[0], 0u);
    block.compute(BlockLayout::kRowMajor, arrays.in(rows), loads.data(), arrays.out(rows));
    EXPECT_EQ(arrays.differences(), std::vector<std::size_t>(5, 0)) << toString(set);
  }
}

TEST(BlockFarColumns, AreTheRowsBitForBit) {
  for (const std::size_t samples : {4096, 4097, 4607, 5120, 6001}) {
    SCOPED_TRACE(samples);
    expectColumnsLikeRows<double>(samples, 1);
    expectColumnsLikeRows<double>(samples, 2);
    expectColumnsLikeRows<float>(2 * samples + 1, 1);
  }
}

// Reading or writing outside the arrays crashes; results that nobody wants are not written.
TEST(BlockFarColumns, KeepWithinTheirArrays) {
  constexpr std::size_t kSamples = 5001, kKinds = 10;
  RandomRobot random(1, 16);
  const Mechanism mechanism = readUrdf(random.urdf());
  std::vector<Motion> kinds, motions;
  for (std::size_t n = 0; n < kKinds; ++n) kinds.push_back(random.motion(mechanism));
  for (std::size_t n = 0; n < kSamples; ++n) motions.push_back(kinds[n % kKinds]);
  const InverseDynamics dynamics(mechanism, Scene(), requestEveryJoint(mechanism));
  BlockInverseDynamics<double> block(dynamics, 2);
  const auto expected = blockResults(block, kinds, BlockLayout::kStructureOfArrays);
  for (const auto edge : {FencedArray<double>::kFenceBehind, FencedArray<double>::kFenceBefore}) {
    FencedBlock<double> arrays(block, motions, BlockLayout::kStructureOfArrays, edge);
    const PlainResults<double> untouched = arrays.sample(0);
    ResultBlock<double> out = arrays.out();
    out.child_axes = out.twists = nullptr;
    block.compute(BlockLayout::kStructureOfArrays, arrays.in(), out);
    EXPECT_TRUE(arrays.surroundingsUntouched());
    for (std::size_t n = 0; n < kSamples; ++n) {
      PlainResults<double> right = expected[n % kKinds];
      right.child_axes = untouched.child_axes;
      right.twists = untouched.twists;
      ASSERT_EQ(differences(arrays.sample(n), right), "") << "sample " << n;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
