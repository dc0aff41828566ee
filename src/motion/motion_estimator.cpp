#include "virtual_work_dynamics/motion_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "motion/polynomial_fit.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kTurn = 6.283185307179586476925286766559;
constexpr int kMaxWindow = PolynomialFit::kMaxWindow;
/// Number of samples held of a coordinate, a power of two. They are more than a window, so that a
/// coordinate that comes more often than the others still has samples around the common instant.
constexpr int kHistory = 512;
/// Number of sets of weights held; more groups of coordinates than that are fitted anew each time.
constexpr std::size_t kMaxFits = 32;

struct Sample {
  std::int64_t stamp;  // ns
  double q;            // position as it came
  double turns;        // q and so many whole turns are the unwrapped position
  double qd;
  bool has_qd;
};

/// The last samples of a coordinate; the oldest makes room for the newest.
class History {
 public:
  explicit History(int capacity) : samples_(static_cast<std::size_t>(capacity)) {}

  int size() const { return size_; }
  bool full() const { return size_ == capacity(); }
  void clear() { size_ = 0; }
  void push(const Sample& sample) {
    newest_ = (newest_ + 1) & (capacity() - 1);
    samples_[static_cast<std::size_t>(newest_)] = sample;
    if (!full()) ++size_;
  }
  /// The sample `age` samples older than the newest, 0 <= age < size().
  const Sample& operator[](int age) const {
    return samples_[static_cast<std::size_t>((newest_ - age) & (capacity() - 1))];
  }

 private:
  int capacity() const { return static_cast<int>(samples_.size()); }

  std::vector<Sample> samples_;
  int newest_ = -1;
  int size_ = 0;
};

struct Coordinate {
  Coordinate(const Joint& joint, int capacity) : turn_counter(joint), history(capacity) {}

  TurnCounter turn_counter;
  bool needed = true;
  bool fresh = false;  // refreshed since the last evaluate() or skip()
  bool seen = false;   // whether any sample ever came
  double latest = 0;
  History history;
};

/// Stamps of a window relative to the instant, oldest first, ns.
using Stamps = std::array<std::int64_t, kMaxWindow>;

/// Weights and the window that they were computed for.
struct Fit {
  Stamps stamps{};
  bool velocities = false;
  bool valid = false;
  std::uint64_t used = 0;  // the evaluation that used it last
  PolynomialFit polynomial;
};

template <typename Value>
void refuseSetting(const char* name, Value value, const std::string& range) {
  std::ostringstream text;
  text << "motion estimator: " << name << " is " << value << ", must be " << range;
  throw MotionError(text.str());
}

void checkSettings(const EstimatorSettings& settings) {
  if (!settings.estimate) return;
  if (settings.order < 1 || settings.order > PolynomialFit::kMaxOrder)
    refuseSetting("order", settings.order, "from 1 to " + std::to_string(PolynomialFit::kMaxOrder));
  if (settings.window < settings.order + 1 || settings.window > kMaxWindow)
    refuseSetting("window", settings.window,
                  "from order + 1 = " + std::to_string(settings.order + 1) + " to " +
                      std::to_string(kMaxWindow));
  if (settings.lag < 0 || settings.lag >= settings.window)
    refuseSetting("lag", settings.lag,
                  "from 0 to window - 1 = " + std::to_string(settings.window - 1));
  if (!std::isfinite(settings.max_gap) || settings.max_gap <= 0)
    refuseSetting("max_gap", settings.max_gap, "a positive number of seconds");
}

/// Converts s to ns, at most the largest number of 64 bits.
std::int64_t nanoseconds(double seconds) {
  constexpr double longest = 9.2e9;
  if (!(seconds < longest)) return std::numeric_limits<std::int64_t>::max();
  return std::llround(seconds * 1e9);
}

}  // namespace

struct MotionEstimator::Impl {
  Impl(const Mechanism& mechanism, const EstimatorSettings& settings);

  Verdict judge(std::int64_t stamp, const int* indices, int count);
  void clear();
  void markStale();
  bool full() const;
  bool commonInstant(std::int64_t& instant) const;
  int windowAge(const History& history, std::int64_t instant) const;
  const PolynomialFit& weights(bool velocities);
  void fitAt(std::int64_t instant, Motion& motion);
  void copyNewest(Motion& motion) const;

  const bool estimate;
  const bool use_velocity;
  const int window;
  const int order;
  const int lag;
  const std::int64_t max_gap;  // ns
  std::vector<Coordinate> coordinates;
  std::vector<Fit> fits;
  std::uint64_t evaluation = 0;
  std::int64_t latest_gap = 0;  // ns

  // One window, oldest sample first.
  Stamps stamps{};
  std::array<double, kMaxWindow> positions{};  // unwrapped, relative to the first
  std::array<double, kMaxWindow> velocities{};
};

MotionEstimator::Impl::Impl(const Mechanism& mechanism, const EstimatorSettings& settings)
    : estimate(settings.estimate),
      use_velocity(settings.use_velocity),
      window(estimate ? settings.window : 1),
      order(settings.order),
      lag(estimate ? settings.lag : 0),
      max_gap(estimate ? nanoseconds(settings.max_gap) : std::numeric_limits<std::int64_t>::max()) {
  coordinates.reserve(mechanism.coordinates().size());
  for (const int joint : mechanism.coordinates()) {
    coordinates.emplace_back(mechanism.joint(joint), estimate ? kHistory : 1);
  }
  if (estimate) fits.resize(std::min(coordinates.size(), kMaxFits));
}

/// Decides what to do with a message of this stamp. A stamp earlier than the sample of any
/// coordinate in it means that time went back; an equal one is dropped even when others have a gap.
MotionEstimator::Verdict MotionEstimator::Impl::judge(std::int64_t stamp, const int* indices,
                                                      int count) {
  bool equal = false;
  latest_gap = 0;
  for (int i = 0; i < count; ++i) {
    const History& history = coordinates[static_cast<std::size_t>(indices[i])].history;
    if (history.size() == 0) continue;
    const std::int64_t newest = history[0].stamp;
    if (stamp < newest) return Verdict::kRestartedBack;
    equal = equal || stamp == newest;
    latest_gap = std::max(latest_gap, stamp - newest);
  }
  if (equal) return Verdict::kEqualStamp;
  return latest_gap > max_gap ? Verdict::kRestartedGap : Verdict::kAccepted;
}

void MotionEstimator::Impl::clear() {
  for (Coordinate& coordinate : coordinates) {
    coordinate.history.clear();
    coordinate.turn_counter.restart();
  }
  markStale();
}

void MotionEstimator::Impl::markStale() {
  for (Coordinate& coordinate : coordinates) coordinate.fresh = false;
}

/// True when every coordinate that is needed is fresh and has a full window.
bool MotionEstimator::Impl::full() const {
  for (const Coordinate& coordinate : coordinates)
    if (coordinate.needed && (!coordinate.fresh || coordinate.history.size() < window))
      return false;
  return !coordinates.empty();
}

/// Finds the instant at which every coordinate can be evaluated; to be called when full() only.
/// @returns false when a coordinate began later than that.
bool MotionEstimator::Impl::commonInstant(std::int64_t& instant) const {
  instant = std::numeric_limits<std::int64_t>::max();
  for (const Coordinate& coordinate : coordinates)
    if (coordinate.needed) instant = std::min(instant, coordinate.history[lag].stamp);
  if (!estimate) return true;
  // A polynomial must not be evaluated outside of its samples. Where the history is too short, the
  // instant moves into it; where it still grows, waiting helps.
  const std::int64_t earliest = instant;
  for (const Coordinate& coordinate : coordinates) {
    if (!coordinate.needed) continue;
    const History& history = coordinate.history;
    if (history[window - 1].stamp > earliest && history.full())
      instant = std::max(instant, history[history.size() - 1].stamp);
  }
  for (const Coordinate& coordinate : coordinates) {
    if (!coordinate.needed) continue;
    const History& history = coordinate.history;
    if (history[window - 1].stamp > instant && history[history.size() - 1].stamp > instant)
      return false;
  }
  return true;
}

/// Age of the newest sample of the window whose sample `lag` behind it is nearest to the instant.
int MotionEstimator::Impl::windowAge(const History& history, std::int64_t instant) const {
  int age = 0;
  while (age + window < history.size() && history[age + lag].stamp > instant &&
         history[age + lag].stamp - instant > std::abs(history[age + lag + 1].stamp - instant))
    ++age;
  return age;
}

/// Returns the weights for `stamps`, which are computed only if no set of weights held fits.
const PolynomialFit& MotionEstimator::Impl::weights(bool with_velocities) {
  Fit* spare = &fits.front();
  for (Fit& fit : fits) {
    if (fit.valid && fit.velocities == with_velocities &&
        std::equal(stamps.begin(), stamps.begin() + window, fit.stamps.begin())) {
      fit.used = evaluation;
      return fit.polynomial;
    }
    if (spare->used == evaluation && fit.used != evaluation) spare = &fit;
  }
  std::array<double, kMaxWindow> times;
  for (int i = 0; i < window; ++i)
    times[static_cast<std::size_t>(i)] =
        static_cast<double>(stamps[static_cast<std::size_t>(i)]) * 1e-9;
  spare->valid = false;
  spare->polynomial.fit(times.data(), window, order, with_velocities);
  spare->stamps = stamps;
  spare->velocities = with_velocities;
  spare->valid = true;
  spare->used = evaluation;
  return spare->polynomial;
}

void MotionEstimator::Impl::fitAt(std::int64_t instant, Motion& motion) {
  ++evaluation;
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    if (!coordinates[c].needed) continue;
    const History& history = coordinates[c].history;
    const int newest = windowAge(history, instant);
    // Turns are relative to the first sample, too: however far a joint has turned, the differences
    // that make the acceleration keep their digits.
    const Sample& first = history[newest + window - 1];
    bool all_velocities = use_velocity;
    for (int i = 0; i < window; ++i) {
      const Sample& sample = history[newest + window - 1 - i];
      const auto at = static_cast<std::size_t>(i);
      stamps[at] = sample.stamp - instant;
      positions[at] = (sample.q - first.q) + kTurn * (sample.turns - first.turns);
      velocities[at] = sample.qd;
      all_velocities = all_velocities && sample.has_qd;
    }
    const auto out = static_cast<Eigen::Index>(c);
    weights(all_velocities)
        .evaluate(positions.data(), velocities.data(), motion.q[out], motion.qd[out],
                  motion.qdd[out]);
    motion.q[out] += first.q + kTurn * first.turns;
  }
}

void MotionEstimator::Impl::copyNewest(Motion& motion) const {
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    if (!coordinates[c].needed) continue;
    const Sample& newest = coordinates[c].history[0];
    const auto out = static_cast<Eigen::Index>(c);
    motion.q[out] = newest.q + kTurn * newest.turns;
    motion.qd[out] = newest.qd;
    motion.qdd[out] = 0;
  }
}

MotionEstimator::MotionEstimator(const Mechanism& mechanism, const EstimatorSettings& settings) {
  checkSettings(settings);
  impl_ = std::make_unique<Impl>(mechanism, settings);
}

MotionEstimator::~MotionEstimator() = default;

MotionEstimator::Verdict MotionEstimator::push(std::int64_t stamp_ns, const int* coordinates,
                                               const double* q, const double* qd, int count) {
  const Verdict verdict = impl_->judge(stamp_ns, coordinates, count);
  if (verdict == Verdict::kEqualStamp) return verdict;
  if (verdict != Verdict::kAccepted) impl_->clear();
  for (int i = 0; i < count; ++i) {
    Coordinate& coordinate = impl_->coordinates[static_cast<std::size_t>(coordinates[i])];
    History& history = coordinate.history;
    const double since =
        history.size() > 0 ? static_cast<double>(stamp_ns - history[0].stamp) * 1e-9 : 0;
    const double turns = coordinate.turn_counter.turns(q[i], since);
    history.push({stamp_ns, q[i], turns, qd ? qd[i] : 0, qd != nullptr});
    coordinate.latest = q[i] + kTurn * turns;
    coordinate.seen = true;
    coordinate.fresh = true;
  }
  return verdict;
}

void MotionEstimator::waitFor(const std::vector<bool>& coordinates) {
  if (coordinates.size() != impl_->coordinates.size())
    throw MotionError("motion estimator: got " + std::to_string(coordinates.size()) +
                      " entries for the coordinates to wait for, the mechanism has " +
                      std::to_string(impl_->coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    impl_->coordinates[i].needed = coordinates[i];
}

std::int64_t MotionEstimator::latestGap() const {
  return impl_->latest_gap;
}

bool MotionEstimator::ready() const {
  std::int64_t instant = 0;
  return impl_->full() && impl_->commonInstant(instant);
}

std::int64_t MotionEstimator::evaluate(Motion& motion) {
  std::int64_t instant = 0;
  if (!impl_->full() || !impl_->commonInstant(instant))
    throw MotionError("motion estimator: asked for a motion before it was ready");
  const auto size = static_cast<Eigen::Index>(impl_->coordinates.size());
  if (motion.q.size() != size || motion.qd.size() != size || motion.qdd.size() != size)
    throw MotionError("motion estimator: the motion has " + std::to_string(motion.q.size()) +
                      " positions, " + std::to_string(motion.qd.size()) + " velocities and " +
                      std::to_string(motion.qdd.size()) + " accelerations, must have " +
                      std::to_string(size) + " of each");
  if (impl_->estimate) {
    impl_->fitAt(instant, motion);
  } else {
    impl_->copyNewest(motion);
  }
  impl_->markStale();
  return instant;
}

void MotionEstimator::skip() {
  impl_->markStale();
}

void MotionEstimator::reset() {
  impl_->clear();
}

bool MotionEstimator::latestPosition(int coordinate, double& q) const {
  const Coordinate& from = impl_->coordinates[static_cast<std::size_t>(coordinate)];
  if (!from.seen) return false;
  q = from.latest;
  return true;
}

bool MotionEstimator::stale(int coordinate) const {
  return !impl_->coordinates[static_cast<std::size_t>(coordinate)].fresh;
}

}  // namespace virtual_work_dynamics
