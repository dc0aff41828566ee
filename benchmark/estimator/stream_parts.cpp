#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/calibration.h"
#include "estimator/effort_judge.h"
#include "estimator/estimator_runs.h"
#include "estimator/fixed_lag_smoother.h"
#include "estimator/local_polynomial.h"
#include "estimator/noise_smoother.h"
#include "estimator/report_parts.h"
#include "estimator/savitzky_golay.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kNoLag = -1;         // ms
constexpr double kEnd = 0.5;          // s, within which rows belong to an end
constexpr double kLearnt = 1;         // s, from which the node is judged
constexpr double kNodeEnd = 0.15;     // s before the end that no lag reaches
constexpr std::size_t kInner = 1000;  // rows that are judged
constexpr std::size_t kOuter = 100;   // at each end
constexpr std::size_t kNodeRows = 500;
const std::vector<double> kLags{0, 0.01, 0.02, 0.05, 0.1};  // s
constexpr double kDefaultLag = 0.05;

std::vector<std::size_t> innerRows(const EncoderRecording& recording) {
  return rowsBetween(recording, kEnd, recording.times.back() - kEnd, kInner);
}

std::vector<std::size_t> endRows(const EncoderRecording& recording) {
  std::vector<std::size_t> rows = rowsBetween(recording, 0, kEnd, kOuter);
  const double end = recording.times.back();
  const std::vector<std::size_t> last = rowsBetween(recording, end - kEnd, end + 1, kOuter);
  rows.insert(rows.end(), last.begin(), last.end());
  return rows;
}

/// The median of what a quality has of all joints.
template <typename Value>
double median(const std::vector<StreamQuality>& qualities, Value value) {
  std::vector<double> values;
  for (const StreamQuality& quality : qualities) values.push_back(value(quality));
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Judges a contender inside and at the ends.
struct Contest {
  const StreamSpec& spec;
  const ReportRows& rows;
  EffortJudge inside;
  EffortJudge ends;

  template <typename Motions>
  void judge(const char* method, const Motions& motions) const {
    rows.add("offline", spec, method, kNoLag, "error", inside.error(motions(inside.rows())));
    rows.add("offline", spec, method, kNoLag, "end_error", ends.error(motions(ends.rows())));
  }
};

void addCalibration(const Arm& arm, const EffortJudge& judge, const EstimatedRows& estimated,
                    const StreamSpec& spec, const char* method, double lag_ms,
                    const ReportRows& rows) {
  const Calibration within = calibrate(arm.deviations, arm.dynamics, judge, estimated);
  rows.add("calibration", spec, method, lag_ms, "acceleration", within.acceleration);
  rows.add("calibration", spec, method, lag_ms, "effort", within.effort);
}

}  // namespace

Arm Arm::read() {
  Mechanism mechanism = readUrdfFile(VWD_SOURCE_DIR "/urdf/six_axis_arm.urdf");
  Scene scene;
  scene.reactions = ReactionSelection::kNone;
  Deviations deviations(mechanism, scene, Request());
  InverseDynamics dynamics(mechanism, scene);
  return {std::move(mechanism), std::move(dynamics), std::move(deviations)};
}

void measureOffline(const Arm& arm, const StreamSpec& spec, const ReportRows& rows) {
  const EncoderRecording recording = record(spec);
  const EncoderRecording even = record(spec.even());
  const EffortJudge even_inside(arm.dynamics, even, innerRows(even));
  const EffortJudge even_ends(arm.dynamics, even, endRows(even));
  const SavitzkyGolay filter(even, even_inside);
  rows.add("offline", spec, "savitzky_golay", kNoLag, "error", filter.error());
  rows.add("offline", spec, "savitzky_golay", kNoLag, "window_ms",
           1e3 * filter.window() / spec.rate);
  rows.add("offline", spec, "savitzky_golay", kNoLag, "end_error",
           even_ends.error(filter.motions(even, even_ends.rows())));

  const Contest contest{spec, rows, EffortJudge(arm.dynamics, recording, innerRows(recording)),
                        EffortJudge(arm.dynamics, recording, endRows(recording))};
  std::vector<std::size_t> all = contest.inside.rows();
  all.insert(all.end(), contest.ends.rows().begin(), contest.ends.rows().end());
  EstimatedRows estimated = complete(arm.mechanism, recording, all);
  const auto inner = static_cast<std::ptrdiff_t>(contest.inside.rows().size());
  const std::vector<Motion> at_ends(estimated.motions.begin() + inner, estimated.motions.end());
  estimated.motions.erase(estimated.motions.begin() + inner, estimated.motions.end());
  rows.add("offline", spec, "default", kNoLag, "error", contest.inside.error(estimated.motions));
  rows.add("offline", spec, "default", kNoLag, "end_error", contest.ends.error(at_ends));
  rows.add("offline", spec, "default", kNoLag, "position_noise_rad",
           median(estimated.qualities, [](const StreamQuality& q) { return q.position_noise; }));
  addCalibration(arm, contest.inside, estimated, spec, "default", kNoLag, rows);

  using Rows = std::vector<std::size_t>;
  contest.judge("nine_samples", [&](const Rows& at) { return nineSamples(recording, at); });
  const LocalPolynomial polynomial(recording);
  contest.judge("local_polynomial", [&](const Rows& at) { return polynomial.motions(at); });
  const char* const names[] = {"white_jerk", "white_snap", "white_fifth"};
  for (int order = 3; order <= 5; ++order) {
    const NoiseSmoother smoother = NoiseSmoother::byLikelihood(recording, order);
    contest.judge(names[order - 3], [&](const Rows& at) { return smoother.motions(at); });
  }
  const NoiseSmoother spline = NoiseSmoother::spline(recording);
  contest.judge("spline", [&](const Rows& at) { return spline.motions(at); });
}

void measureNode(const Arm& arm, const StreamSpec& spec, const ReportRows& rows) {
  const EncoderRecording recording = record(spec);
  const double end = recording.times.back() - kNodeEnd;
  const EffortJudge learnt(arm.dynamics, recording,
                           rowsBetween(recording, kLearnt, end, kNodeRows));
  const EffortJudge learning(arm.dynamics, recording, rowsBetween(recording, 0, kLearnt, 200));
  const std::vector<double> best = leastErrorsWithLag(recording, learnt, kLags);
  const std::vector<double> best_learning = leastErrorsWithLag(recording, learning, kLags);
  for (std::size_t i = 0; i < kLags.size(); ++i) {
    const double lag_ms = 1e3 * kLags[i];
    EstimatorSettings settings;
    settings.lag = kLags[i];
    rows.add("node", spec, "hindsight", lag_ms, "error", best[i]);
    rows.add("node", spec, "hindsight", lag_ms, "first_second_error", best_learning[i]);
    const EstimatedRows estimated = estimate(arm.mechanism, recording, learnt.rows(), settings);
    rows.add("node", spec, "default", lag_ms, "error", learnt.error(estimated.motions));
    rows.add("node", spec, "default", lag_ms, "missing", static_cast<double>(estimated.missing));
    const EstimatedRows first = estimate(arm.mechanism, recording, learning.rows(), settings);
    rows.add("node", spec, "default", lag_ms, "first_second_error", learning.error(first.motions));
    if (kLags[i] == kDefaultLag) addCalibration(arm, learnt, estimated, spec, "node", lag_ms, rows);
  }
}

void measureWrongVelocities(const Arm& arm, const StreamSpec& spec, const ReportRows& rows) {
  const EncoderRecording recording = record(spec);
  const EffortJudge inside(arm.dynamics, recording, innerRows(recording));
  const EffortJudge learnt(
      arm.dynamics, recording,
      rowsBetween(recording, kLearnt, recording.times.back() - kNodeEnd, kNodeRows));
  for (const bool use : {true, false}) {
    const char* const method = use ? "default" : "positions_only";
    CompletionSettings offline;
    offline.noise.use_velocity = use;
    const EstimatedRows completed = complete(arm.mechanism, recording, inside.rows(), offline);
    rows.add("wrong_velocities", spec, method, kNoLag, "error", inside.error(completed.motions));
    EstimatorSettings node;
    node.noise.use_velocity = use;
    const EstimatedRows estimated = estimate(arm.mechanism, recording, learnt.rows(), node);
    const double lag_ms = 1e3 * node.lag;
    rows.add("wrong_velocities", spec, method, lag_ms, "error", learnt.error(estimated.motions));
    if (!use) continue;
    const auto ratio = [](const StreamQuality& quality) { return quality.velocity_ratio; };
    rows.add("wrong_velocities", spec, method, kNoLag, "velocity_ratio",
             median(completed.qualities, ratio));
    rows.add("wrong_velocities", spec, method, lag_ms, "velocity_ratio",
             median(estimated.qualities, ratio));
  }
}

void measureTime(const Arm& arm, bool quick, const ReportRows& rows) {
  for (const int rate : {1000, 4000})
    for (const VelocityKind velocity : {VelocityKind::kNone, VelocityKind::kGood}) {
      StreamSpec spec;
      spec.group = "time";
      spec.rate = rate;
      spec.velocity = velocity;
      spec.seconds = quick ? 2 : 6;
      const EstimatorSettings settings;
      rows.add("time", spec, "default", 1e3 * settings.lag, "ns_per_sample",
               timePerSample(arm.mechanism, record(spec), settings));
    }
}

}  // namespace virtual_work_dynamics
