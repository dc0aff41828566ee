#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "encoder_streams.h"
#include "tested_build.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/urdf_reader.h"

// Recordings of the six-axis arm against the best filter of Savitzky and Golay that hindsight
// finds.

namespace virtual_work_dynamics {
namespace {

using namespace encoder_streams;

constexpr std::size_t kJoints = 6;
constexpr double kEnd = 0.5;  // s at the ends, which are judged separately

/// Efforts of the arm at rows of a stream, and how far others are from them.
class Arm {
 public:
  Arm()
      : mechanism_(readUrdfFile(std::string(kSourceFolder) + "/urdf/six_axis_arm.urdf")),
        dynamics_(mechanism_, scene()),
        workspace_(dynamics_.makeWorkspace()) {}

  const Mechanism& mechanism() const { return mechanism_; }

  /// Root mean square of what `motion_of(row)` makes the effort of the worst joint err by, over the
  /// root mean square of its effort.
  template <typename MotionOf>
  double error(const Samples& samples, const std::vector<std::size_t>& rows,
               const MotionOf& motion_of) {
    Eigen::ArrayXd error = Eigen::ArrayXd::Zero(kJoints);
    Eigen::ArrayXd size = error;
    Motion truth(kJoints);
    for (const std::size_t row : rows) {
      for (std::size_t joint = 0; joint < kJoints; ++joint) {
        const State& state = samples.truth[joint][row];
        const auto at = static_cast<Eigen::Index>(joint);
        truth.q[at] = state.q;
        truth.qd[at] = state.qd;
        truth.qdd[at] = state.qdd;
      }
      dynamics_.compute(truth, workspace_);
      const Eigen::ArrayXd expected = workspace_.results().effort.array();
      dynamics_.compute(motion_of(row), workspace_);
      error += (workspace_.results().effort.array() - expected).square();
      size += expected.square();
    }
    return std::sqrt((error / size).maxCoeff());
  }

 private:
  static Scene scene() {
    Scene scene;
    scene.reactions = ReactionSelection::kNone;
    return scene;
  }

  Mechanism mechanism_;
  InverseDynamics dynamics_;
  Workspace workspace_;
};

std::vector<std::size_t> rowsBetween(const Samples& samples, double from, double to) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < samples.rows(); ++row)
    if (samples.stamps[row] >= from && samples.stamps[row] < to) rows.push_back(row);
  const std::size_t step = std::max<std::size_t>(1, rows.size() / 300);
  std::vector<std::size_t> few;
  for (std::size_t i = 0; i < rows.size(); i += step) few.push_back(rows[i]);
  return few;
}

/// The least error of any window; `samples` are even.
double bestWindow(Arm& arm, const Samples& samples, double rate, double from, double to) {
  double best = std::numeric_limits<double>::infinity();
  const std::vector<std::size_t> rows = rowsBetween(samples, from, to);
  for (double size = 7; size < 0.8 * rate; size *= 1.2) {
    const int width = static_cast<int>(size) | 1;
    const Eigen::MatrixXd weights = savitzkyGolay(width, 1 / rate);
    Motion motion(kJoints);
    best = std::min(best, arm.error(samples, rows, [&](std::size_t row) -> const Motion& {
      const std::size_t first = row - static_cast<std::size_t>(width / 2);
      for (std::size_t joint = 0; joint < kJoints; ++joint) {
        const Eigen::Map<const Eigen::VectorXd> window(&samples.positions[joint][first], width);
        const Eigen::Vector3d state = weights * window;
        const auto at = static_cast<Eigen::Index>(joint);
        motion.q[at] = state[0];
        motion.qd[at] = state[1];
        motion.qdd[at] = state[2];
      }
      return motion;
    }));
  }
  return best;
}

MotionTable tableOf(const Mechanism& mechanism, const Samples& samples) {
  MotionTable table;
  table.joints = mechanism.coordinateNames();
  table.times = samples.stamps;
  const auto rows = static_cast<Eigen::Index>(samples.rows());
  table.positions.resize(rows, kJoints);
  if (!samples.velocities.empty()) table.velocities.resize(rows, kJoints);
  for (std::size_t joint = 0; joint < kJoints; ++joint)
    for (Eigen::Index row = 0; row < rows; ++row) {
      const auto column = static_cast<Eigen::Index>(joint);
      table.positions(row, column) = samples.positions[joint][static_cast<std::size_t>(row)];
      if (!samples.velocities.empty())
        table.velocities(row, column) = samples.velocities[joint][static_cast<std::size_t>(row)];
    }
  return table;
}

double errorOf(Arm& arm, const Samples& samples, const MotionTable& table, double from, double to) {
  Motion motion(kJoints);
  return arm.error(samples, rowsBetween(samples, from, to), [&](std::size_t row) -> const Motion& {
    const auto at = static_cast<Eigen::Index>(row);
    motion.q = table.positions.row(at);
    motion.qd = table.velocities.row(at);
    motion.qdd = table.accelerations.row(at);
    return motion;
  });
}

enum class Kind { kJerkLimited, kTrapezoid, kFourier };

std::vector<Law> lawsOf(Kind kind, double duration, unsigned seed, bool one_still) {
  std::vector<Law> laws;
  for (unsigned joint = 0; joint < kJoints; ++joint) {
    if (kind == Kind::kFourier) {
      laws.push_back(fourierLaw(seed + joint));
    } else {
      laws.push_back(Moves(seed + joint, duration, kind == Kind::kTrapezoid ? 0 : 0.1));
    }
  }
  if (one_still) laws[2] = [](double) { return State{0.3, 0, 0}; };
  return laws;
}

struct Case {
  const char* name;
  Kind kind;
  bool one_still;
  double rate, quantum, white, jitter, uneven, dropped, velocity_noise;
};

constexpr double kDuration = 4;

void expectAccurate(const Case& c) {
  SCOPED_TRACE(c.name);
  Arm arm;
  Encoder encoder;
  encoder.rate = c.rate;
  encoder.quantum = c.quantum;
  encoder.white = c.white;
  encoder.jitter = c.jitter;
  encoder.uneven = c.uneven;
  encoder.dropped = c.dropped;
  encoder.velocity_noise = c.velocity_noise;
  const std::vector<Law> laws = lawsOf(c.kind, kDuration, 21, c.one_still);
  const Samples samples = sampled(laws, encoder, kDuration, 1);
  encoder.jitter = encoder.uneven = encoder.dropped = 0;
  const Samples even = sampled(laws, encoder, kDuration, 1);
  const double best = bestWindow(arm, even, c.rate, kEnd, kDuration - kEnd);
  CompletionSettings settings;
  settings.covariances = true;
  CompletionReport report;
  const MotionTable table =
      completeMotion(arm.mechanism(), tableOf(arm.mechanism(), samples), settings, &report);
  const double error = errorOf(arm, samples, table, kEnd, kDuration - kEnd);
  EXPECT_LE(error, 1.1 * best);
  // At the ends rows lie on one side only; in most of these streams the arm rests there.
  const double first = errorOf(arm, samples, table, 0, kEnd);
  const double last = errorOf(arm, samples, table, kDuration - kEnd, kDuration);
  EXPECT_LE(std::max(first, last), 10 * best);
  EXPECT_TRUE(report.estimated);
  EXPECT_EQ(report.gaps, 0u);
  EXPECT_GT(report.one_sided, 0u);
  EXPECT_EQ(report.even_clock, c.jitter > 0);
  // Of the accelerations most are within two of their deviations.
  std::size_t within = 0;
  std::size_t all = 0;
  for (std::size_t row = 0; row < samples.rows(); ++row)
    for (std::size_t joint = 0; joint < kJoints; ++joint) {
      if (c.one_still && joint == 2) continue;
      const double deviation = std::sqrt(table.covariances[row * kJoints + joint](2, 2));
      const double acceleration =
          table.accelerations(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(joint));
      within += std::abs(acceleration - samples.truth[joint][row].qdd) <= 2 * deviation;
      ++all;
    }
  EXPECT_GT(static_cast<double>(within), 0.90 * static_cast<double>(all));
  EXPECT_LT(static_cast<double>(within), 0.99 * static_cast<double>(all));
}

TEST(MotionCompletionAccuracy, OfJerkLimitedMovesIsThatOfTheBestWindow) {
  constexpr Kind kind = Kind::kJerkLimited;
  expectAccurate({"rate_125", kind, false, 125, 1e-4, 0, 0, 0, 0, -1});
  expectAccurate({"rate_500", kind, false, 500, 1e-5, 0, 0, 0, 0, -1});
  expectAccurate({"rate_1000", kind, false, 1000, 1e-3, 0, 0, 0, 0, -1});
  expectAccurate({"velocities", kind, false, 500, 1e-4, 0, 0, 0, 0, 2e-3});
}

TEST(MotionCompletionAccuracy, OfJitteredOrMissingRowsIsThatOfTheBestWindowOfEvenOnes) {
  constexpr Kind kind = Kind::kJerkLimited;
  expectAccurate({"jitter", kind, false, 1000, 1e-4, 0, 1e-4, 0, 0, -1});
  expectAccurate({"dropped", kind, false, 500, 1e-4, 0, 0, 0, 0.02, -1});
  expectAccurate({"uneven", kind, false, 500, 1e-4, 0, 0, 0.8, 0, -1});
  expectAccurate({"white_noise", kind, false, 500, 1e-4, 3e-4, 0, 0, 0, -1});
}

TEST(MotionCompletionAccuracy, OfOtherMotionsIsThatOfTheBestWindow) {
  expectAccurate({"trapezoid", Kind::kTrapezoid, false, 500, 1e-4, 0, 0, 0, 0, -1});
  expectAccurate({"fourier", Kind::kFourier, false, 500, 1e-4, 0, 0, 0, 0, -1});
  expectAccurate({"coarse_fourier", Kind::kFourier, false, 1000, 1e-3, 0, 0, 0, 0, -1});
  expectAccurate({"one_still", Kind::kJerkLimited, true, 500, 1e-4, 0, 0, 0, 0, -1});
}

}  // namespace
}  // namespace virtual_work_dynamics
