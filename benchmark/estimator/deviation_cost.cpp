// What standard deviations of a sample's results cost, beside a block of as many samples as they
// are made of.
#include <time.h>

#include <algorithm>
#include <vector>

#include "estimator/report_parts.h"
#include "virtual_work_dynamics/block.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kRounds = 101;
constexpr int kCalls = 300;  // of a round

/// CPU time of this thread, ns.
double threadTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <typename Call>
double nsPerCall(const Call& call) {
  const double start = threadTime();
  for (int i = 0; i < kCalls; ++i) call();
  return (threadTime() - start) / kCalls;
}

}  // namespace

void measureDeviationCost(const Arm& arm, const ReportRows& rows) {
  const auto n = static_cast<std::size_t>(kArmJoints);
  const std::size_t samples = kMotionLevels * n + 1;
  for (const bool reactions : {false, true}) {
    Scene scene;
    scene.reactions = reactions ? ReactionSelection::kAll : ReactionSelection::kNone;
    Request request;
    if (reactions) request.root_axes = requestedReactions(arm.mechanism, scene);
    const Deviations deviations(arm.mechanism, scene, request);
    Deviations::Workspace workspace = deviations.makeWorkspace();
    Motion motion(kArmJoints);
    MotionCovariance covariance;
    covariance.coordinates.assign(n, Eigen::Vector3d(1e-10, 1e-6, 1e-2).asDiagonal());
    for (Eigen::Index j = 0; j < kArmJoints; ++j) {
      motion.q[j] = 0.3 + 0.1 * static_cast<double>(j);
      motion.qd[j] = 1 - 0.2 * static_cast<double>(j);
      motion.qdd[j] = 0.5 * static_cast<double>(j) - 1;
    }
    BlockInverseDynamics<double> block(InverseDynamics(arm.mechanism, scene, request));
    const auto repeated = [&](const Eigen::VectorXd& values) {
      std::vector<double> array;
      for (std::size_t j = 0; j < n; ++j)
        array.insert(array.end(), samples, values[static_cast<Eigen::Index>(j)]);
      return array;
    };
    const std::vector<double> q = repeated(motion.q);
    const std::vector<double> qd = repeated(motion.qd);
    const std::vector<double> qdd = repeated(motion.qdd);
    std::vector<double> effort(n * samples);
    std::vector<double> wrenches(6 * request.root_axes.size() * samples);
    MotionBlock<double> motions;
    motions.samples = samples;
    motions.q = q.data();
    motions.qd = qd.data();
    motions.qdd = qdd.data();
    ResultBlock<double> results;
    results.effort = effort.data();
    if (reactions) results.root_axes = wrenches.data();
    std::vector<double> block_times;
    std::vector<double> deviation_times;
    std::vector<double> ratios;
    for (int round = 0; round < kRounds; ++round) {
      block_times.push_back(
          nsPerCall([&] { block.compute(BlockLayout::kStructureOfArrays, motions, results); }));
      deviation_times.push_back(
          nsPerCall([&] { deviations.computeMotion(motion, covariance, workspace); }));
      ratios.push_back(deviation_times.back() / block_times.back());
    }
    StreamSpec spec;
    spec.group = reactions ? "efforts_and_reactions" : "efforts";
    constexpr double kNoLag = -1;
    rows.add("deviation_cost", spec, "block", kNoLag, "ns", median(block_times));
    rows.add("deviation_cost", spec, "deviations", kNoLag, "ns", median(deviation_times));
    rows.add("deviation_cost", spec, "deviations", kNoLag, "ratio", median(ratios));
  }
}

}  // namespace virtual_work_dynamics
