#include "motion/stream_smoother.h"

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
    StreamAdjoint<N> adjoint;
    for (std::size_t part = starts.size(); part-- > 0;) {
      const std::size_t begin = first + part * kPart;
      const std::size_t end = std::min(begin + kPart, last);
      filter(begin, std::min(end + 1, last), starts[part]);
      // The row after the part is the first of the next one, whose adjoint is at hand.
      for (std::size_t row = end; row-- > begin;) {
        if (row + 1 < last) step(row + 1, steps_[row + 1 - begin], adjoint);
        take(row, result(row == begin ? starts[part] : steps_[row - begin].filtered, adjoint));
      }
    }
  }

  /// Smooths with samples up to `lag` s after each row only.
  template <typename Take>
  void smoothWithLag(std::size_t first, std::size_t last, double lag, const Take& take) {
    const std::size_t wanted = std::min(last, first + startingRows());
    std::size_t started = 0;  // rows that the filter was started from
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
      for (std::size_t later = newest; later > row; --later)
        step(later, steps_[later - first], adjoint);
      take(row, result(steps_[row - first].filtered, adjoint));
    }
  }

 private:
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

  SmoothedSample result(const StreamState<N>& filtered, const StreamAdjoint<N>& adjoint) const {
    SmoothedSample sample;
    sample.motion = (filtered.x + filtered.P * adjoint.r).template head<3>();
    sample.covariance.setZero();
    if (covariance_) {
      const Eigen::Matrix<double, N, N> covariance =
          filtered.P - filtered.P * adjoint.Lambda * filtered.P;
      sample.covariance = covariance.template topLeftCorner<3, 3>();
    }
    return sample;
  }

  const std::vector<StreamBlock>& samples_;
  const StreamModel& model_;
  double interval_;
  bool covariance_;
  std::vector<Step> steps_;
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
