#include "estimator/fixed_lag_smoother.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "motion/stream_filter.h"
#include "motion/stream_model.h"
#include "motion/stream_start.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kOrder = 4;
constexpr double kShortestTime = 0.0015;  // s
constexpr double kLongestTime = 0.15;     // s
constexpr double kGrowth = 1.25;

/// The states of a filter after each row, and what it takes to go back over them.
class FilteredJoint {
 public:
  FilteredJoint(const EncoderRecording& recording, Eigen::Index joint, double time_constant)
      : recording_(recording), joint_(joint), steps_(recording.rows()) {
    const StreamSpec& spec = recording.spec;
    StreamModel model;
    model.position_variance = std::pow(spec.positionNoise(), 2);
    model.velocity_variance = spec.hasVelocities() ? std::pow(spec.velocityNoise(), 2) : -1;
    model.stamp_variance = spec.jitter * spec.jitter;
    model.density = densityFor(time_constant, model.position_variance, kOrder, 1.0 / spec.rate);
    const double interval = 1.0 / spec.rate;
    StreamState<kOrder> state =
        firstState<kOrder>(model, interval, startingSamples(model, kOrder, interval), [&](int i) {
          return std::pair(recording.stamps[static_cast<std::size_t>(i)] - recording.stamps[0],
                           recording.positions(i, joint) - recording.positions(0, joint));
        });
    steps_[0].filtered = state;
    for (std::size_t row = 1; row < steps_.size(); ++row) follow(model, row, state);
  }

  /// Position, velocity and acceleration at a row by rows up to `newest`.
  Eigen::Vector3d smoothed(std::size_t row, std::size_t newest) const {
    StreamAdjoint<kOrder> adjoint;
    for (std::size_t later = newest; later > row; --later) {
      const Step& step = steps_[later];
      if (recording_.spec.hasVelocities()) adjoint.backOver(1, step.velocity, false);
      adjoint.backOver(0, step.position, false);
      adjoint.backBy(recording_.stamps[later] - recording_.stamps[later - 1], false);
    }
    const StreamState<kOrder>& state = steps_[row].filtered;
    const Eigen::Vector4d x = state.x + state.P * adjoint.r;
    return {x[0] + recording_.positions(static_cast<Eigen::Index>(row), joint_), x[1], x[2]};
  }

 private:
  struct Step {
    StreamState<kOrder> filtered;  // position relative to the measured one
    StreamUpdate<kOrder> position;
    StreamUpdate<kOrder> velocity;
  };

  void follow(const StreamModel& model, std::size_t row, StreamState<kOrder>& state) {
    const auto at = static_cast<Eigen::Index>(row);
    Step& step = steps_[row];
    predict<kOrder>(recording_.stamps[row] - recording_.stamps[row - 1], model.density, state);
    state.x[0] -= recording_.positions(at, joint_) - recording_.positions(at - 1, joint_);
    step.position = update<kOrder>(0, -state.x[0], model.variance(state.x[1]), state);
    if (model.usesVelocities())
      step.velocity = update<kOrder>(1, recording_.velocities(at, joint_) - state.x[1],
                                     model.velocity_variance, state);
    step.filtered = state;
  }

  const EncoderRecording& recording_;
  Eigen::Index joint_;
  std::vector<Step> steps_;
};

/// The newest row when the motion at `row` is due: the first that is `lag` later, as in
/// MotionEstimator.
std::size_t newestRow(const EncoderRecording& recording, std::size_t row, double lag) {
  constexpr double kRounding = 1e-9;  // s
  const auto& stamps = recording.stamps;
  const auto due = std::lower_bound(stamps.begin(), stamps.end(), stamps[row] + lag - kRounding);
  return std::min(static_cast<std::size_t>(due - stamps.begin()), stamps.size() - 1);
}

}  // namespace

std::vector<double> leastErrorsWithLag(const EncoderRecording& recording, const EffortJudge& judge,
                                       const std::vector<double>& lags) {
  const std::vector<std::size_t>& rows = judge.rows();
  std::vector<double> least(lags.size(), HUGE_VAL);
  for (double time = kShortestTime; time < kLongestTime; time *= kGrowth) {
    std::vector<std::vector<Motion>> motions(lags.size(),
                                             std::vector<Motion>(rows.size(), Motion(kArmJoints)));
    for (Eigen::Index joint = 0; joint < kArmJoints; ++joint) {
      const FilteredJoint filtered(recording, joint, time);
      for (std::size_t l = 0; l < lags.size(); ++l)
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const Eigen::Vector3d x =
              filtered.smoothed(rows[i], newestRow(recording, rows[i], lags[l]));
          motions[l][i].q[joint] = x[0];
          motions[l][i].qd[joint] = x[1];
          motions[l][i].qdd[joint] = x[2];
        }
    }
    for (std::size_t l = 0; l < lags.size(); ++l)
      least[l] = std::min(least[l], judge.error(motions[l]));
  }
  return least;
}

}  // namespace virtual_work_dynamics
