#include "motion/stream_smoother.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "motion/stream_filter.h"
#include "motion/stream_start.h"

namespace virtual_work_dynamics {
namespace {

/// Rows whose states are kept at once; of longer stretches the first state of each such part is
/// kept, and the part is filtered again on the way back.
constexpr std::size_t kPart = 4096;

/// Smoothed covariance of a row by that of the next one, `dt` later (Rauch, Tung and Striebel
/// 1965), as a sum of what is positive: where little is known, the difference of StreamAdjoint
/// would lose all of its digits. With B = F^-1 Q F^-T, what the noise between the rows does to the
/// earlier one, and K = B (P + B)^-1 it is (I - K) B + (I - K) F^-1 P' F^-T (I - K)^T.
template <int N>
Eigen::Matrix<double, N, N> covarianceBefore(const Eigen::Matrix<double, N, N>& P,
                                             const Eigen::Matrix<double, N, N>& next, double dt,
                                             double density) {
  using Matrix = Eigen::Matrix<double, N, N>;
  StreamState<N> noise;
  noise.P.setZero();
  addNoise<N>(-dt, -density, noise);
  StreamState<N> back;
  back.x.setZero();
  back.P = next;
  predict<N>(-dt, 0, back);
  const Matrix& B = noise.P;
  // Derivatives have units of their own, by which small pivots must not be judged.
  const Eigen::Matrix<double, N, 1> scale = (P + B).diagonal().cwiseSqrt().cwiseInverse();
  const Matrix sum = scale.asDiagonal() * (P + B) * scale.asDiagonal();
  const Matrix scaled = Eigen::LDLT<Matrix>(sum).solve(Matrix(scale.asDiagonal() * B));
  const Matrix rest = Matrix::Identity() - Matrix(scale.asDiagonal() * scaled).transpose();
  const Matrix covariance = rest * B + rest * back.P * rest.transpose();
  return (covariance + covariance.transpose()) / 2;
}

template <int N>
class Smoother {
 public:
  Smoother(const std::vector<StreamBlock>& samples, const StreamModel& model, double interval,
           bool covariance)
      : samples_(samples), model_(model), interval_(interval), covariance_(covariance) {}

  /// Smooths rows first … last - 1, between which there is no gap.
  template <typename Take>
  void smooth(std::size_t first, std::size_t last, const Take& take) {
    std::vector<StreamState<N>> starts;
    StreamState<N> state = start(first, last);
    for (std::size_t row = first; row < last; row += kPart) {
      starts.push_back(state);
      if (row + kPart < last) state = filter(row, std::min(row + kPart, last) + 1, state);
    }
    first_ = first;
    StreamAdjoint<N> adjoint;
    for (std::size_t part = starts.size(); part-- > 0;) {
      const std::size_t begin = first + part * kPart;
      const std::size_t end = std::min(begin + kPart, last);
      filter(begin, std::min(end + 1, last), starts[part]);
      // The row after the part is the first of the next one, whose adjoint is at hand.
      for (std::size_t row = end; row-- > begin;) {
        if (row + 1 < last) step(row + 1, steps_[row + 1 - begin], adjoint);
        const StreamState<N>& filtered = row == begin ? starts[part] : steps_[row - begin].filtered;
        if (covariance_) smoothCovariance(row, row + 1 < last, filtered, adjoint);
        take(row, result(filtered, adjoint));
      }
    }
  }

  /// Smooths with samples up to `lag` s after each row only.
  template <typename Take>
  void smoothWithLag(std::size_t first, std::size_t last, double lag, const Take& take) {
    const std::size_t wanted = std::min(last, first + startingRows());
    std::size_t started = 0;  // rows that the filter was started from
    first_ = first;
    std::size_t newest = first;
    for (std::size_t row = first; row < last; ++row) {
      newest = std::max(newest, row);
      while (newest + 1 < last && samples_[newest + 1].time <= samples_[row].time + lag) ++newest;
      const std::size_t known = std::min(newest + 1, wanted) - first;
      if (known > started) {
        started = known;
        const StreamState<N> state = start(first, first + known);
        filter(first, first + known < wanted ? newest + 1 : last, state);
        steps_[0].filtered = state;
      }
      StreamAdjoint<N> adjoint;
      for (std::size_t later = newest;; --later) {
        const StreamState<N>& filtered = steps_[later - first].filtered;
        if (covariance_ && (later == row || later <= first + kUnsettled))
          smoothCovariance(later, later < newest, filtered, adjoint);
        if (later == row) break;
        step(later, steps_[later - first], adjoint);
      }
      take(row, result(steps_[row - first].filtered, adjoint));
    }
  }

 private:
  /// Rows of a stretch after which the filter knows all derivatives from samples.
  static constexpr std::size_t kUnsettled = N;

  struct Step {
    StreamState<N> filtered;
    StreamUpdate<N> position;
    StreamUpdate<N> velocity;
    bool has_velocity = false;
  };

  std::size_t startingRows() const {
    return static_cast<std::size_t>(startingSamples(model_, N, interval_));
  }

  /// The state at row `first`, found from as many of the rows first … last - 1 as it takes.
  StreamState<N> start(std::size_t first, std::size_t last) const {
    const int count = static_cast<int>(std::min(startingRows(), last - first));
    StreamState<N> state = firstState<N>(model_, interval_, count, [&](int i) {
      const StreamBlock& other = samples_[first + static_cast<std::size_t>(i)];
      return std::pair(other.time - samples_[first].time,
                       other.position - samples_[first].position);
    });
    const double velocity = samples_[first].velocity;
    if (model_.usesVelocities() && !std::isnan(velocity))
      update<N>(1, velocity - state.x[1], model_.velocity_variance, state);
    return state;
  }

  /// Filters rows begin … end - 1, the state at `begin` being given, and keeps the steps. Positions
  /// count from the measured one of each row.
  /// @returns the state at row end - 1.
  StreamState<N> filter(std::size_t begin, std::size_t end, StreamState<N> state) {
    if (steps_.size() < end - begin) steps_.resize(end - begin);
    for (std::size_t row = begin + 1; row < end; ++row) {
      Step& step = steps_[row - begin];
      predict<N>(samples_[row].time - samples_[row - 1].time, model_.density, state);
      state.x[0] -= samples_[row].position - samples_[row - 1].position;
      step.position = update<N>(0, -state.x[0], model_.variance(state.x[1]), state);
      const double velocity = samples_[row].velocity;
      step.has_velocity = model_.usesVelocities() && !std::isnan(velocity);
      if (step.has_velocity)
        step.velocity = update<N>(1, velocity - state.x[1], model_.velocity_variance, state);
      step.filtered = state;
    }
    return state;
  }

  /// Takes the adjoint from after row `row` to after the row before it.
  void step(std::size_t row, const Step& step, StreamAdjoint<N>& adjoint) const {
    if (step.has_velocity) adjoint.backOver(1, step.velocity, covariance_);
    adjoint.backOver(0, step.position, covariance_);
    adjoint.backBy(samples_[row].time - samples_[row - 1].time, covariance_);
  }

  /// Sets the smoothed covariance of a row, with that of the next one where there is a next one and
  /// the filter knows too little yet.
  void smoothCovariance(std::size_t row, bool has_next, const StreamState<N>& filtered,
                        const StreamAdjoint<N>& adjoint) {
    if (has_next && row < first_ + kUnsettled) {
      smoothed_ = covarianceBefore<N>(filtered.P, smoothed_,
                                      samples_[row + 1].time - samples_[row].time, model_.density);
    } else {
      smoothed_ = filtered.P - filtered.P * adjoint.Lambda * filtered.P;
    }
  }

  SmoothedSample result(const StreamState<N>& filtered, const StreamAdjoint<N>& adjoint) const {
    SmoothedSample sample;
    sample.motion = (filtered.x + filtered.P * adjoint.r).template head<3>();
    sample.covariance.setZero();
    if (covariance_) sample.covariance = smoothed_.template topLeftCorner<3, 3>();
    return sample;
  }

  const std::vector<StreamBlock>& samples_;
  const StreamModel& model_;
  double interval_;
  bool covariance_;
  std::vector<Step> steps_;
  std::size_t first_ = 0;  // row of the stretch
  Eigen::Matrix<double, N, N> smoothed_ = Eigen::Matrix<double, N, N>::Zero();
};

template <int N>
void smoothOfOrder(const std::vector<StreamBlock>& samples, const StreamModel& model,
                   double interval, double longest_gap, double lag, bool covariance,
                   const std::function<void(std::size_t, const SmoothedSample&)>& take) {
  Smoother<N> smoother(samples, model, interval, covariance);
  const auto takeWhole = [&](std::size_t row, SmoothedSample sample) {
    sample.motion[0] += samples[row].position;
    take(row, sample);
  };
  std::size_t first = 0;
  for (std::size_t row = 1; row <= samples.size(); ++row) {
    if (row < samples.size() && !samples[row].begins &&
        samples[row].time - samples[row - 1].time <= longest_gap)
      continue;
    if (std::isinf(lag)) {
      smoother.smooth(first, row, takeWhole);
    } else {
      smoother.smoothWithLag(first, row, lag, takeWhole);
    }
    first = row;
  }
}

}  // namespace

void smoothStream(const std::vector<StreamBlock>& samples, const StreamModel& model, int order,
                  double interval, double longest_gap, double lag, bool covariance,
                  const std::function<void(std::size_t row, const SmoothedSample&)>& take) {
  switch (order) {
    case 3:
      return smoothOfOrder<3>(samples, model, interval, longest_gap, lag, covariance, take);
    case 5:
      return smoothOfOrder<5>(samples, model, interval, longest_gap, lag, covariance, take);
    case 6:
      return smoothOfOrder<6>(samples, model, interval, longest_gap, lag, covariance, take);
    default:
      return smoothOfOrder<4>(samples, model, interval, longest_gap, lag, covariance, take);
  }
}

}  // namespace virtual_work_dynamics
