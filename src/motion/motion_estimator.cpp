#include "virtual_work_dynamics/motion_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "motion/coordinate_track.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLongestLag = 1;  // s
/// Joint states one after the other that are behind the newest ones before time is taken to have
/// gone back.
constexpr int kPatience = 10;
/// A coordinate leads in place of another one when it comes so much more often.
constexpr double kFaster = 0.7;

void refuse(const char* name, double value, const std::string& range) {
  std::ostringstream text;
  text << "motion estimator: " << name << " is " << value << ", must be " << range;
  throw MotionError(text.str());
}

void checkSettings(const EstimatorSettings& settings) {
  if (!settings.estimate) return;
  if (!(settings.lag >= 0 && settings.lag <= kLongestLag))
    refuse("lag", settings.lag, "from 0 to 1 s");
  const auto positive = [](const char* name, double value) {
    if (!std::isfinite(value) || value <= 0) refuse(name, value, "a positive number of seconds");
  };
  positive("max_gap", settings.max_gap);
  positive("hold_after", settings.hold_after);
  const auto known = [](const char* name, double value) {
    if (std::isnan(value) || std::isinf(value)) refuse(name, value, "a finite number");
  };
  known("position_noise", settings.noise.position_noise);
  known("velocity_noise", settings.noise.velocity_noise);
  known("stamp_noise", settings.noise.stamp_noise);
  known("bandwidth", settings.noise.bandwidth);
  if (settings.noise.bandwidth == 0) refuse("bandwidth", 0, "positive");
}

/// Converts s to ns, at most a number that may be doubled.
std::int64_t nanoseconds(double seconds) {
  return std::llround(std::min(seconds, 4e9) * 1e9);
}

}  // namespace

struct MotionEstimator::Impl {
  Impl(const Mechanism& mechanism, const EstimatorSettings& settings, std::size_t lengths);

  struct Coordinate {
    Coordinate(const Joint& joint, const EstimatorSettings& settings) : track(joint, settings) {}

    CoordinateTrack track;
    bool needed = true;
    bool seen = false;  // whether any sample ever came
    bool rests = false;
    bool begun = false;      // whether a motion has been given with it
    bool held = false;       // in the latest motion
    std::int64_t first = 0;  // stamp of the first sample, ns
    double latest = 0;
    double rest = 0;
  };

  Coordinate& at(int index) { return coordinates[static_cast<std::size_t>(index)]; }
  bool farBack(std::int64_t stamp, const int* indices, int count) const;
  void clear();
  void chooseLead(int index);
  bool settled(const Coordinate& coordinate) const;
  bool nextInstant(std::int64_t& instant) const;
  bool inDoubt(std::int64_t instant) const;
  void checkSizes(const Motion& motion, const MotionCovariance* covariance,
                  const Motion* lengths) const;
  Eigen::Vector3d motionOf(Coordinate& coordinate, std::int64_t instant,
                           Eigen::Matrix3d* covariance);

  const EstimatorSettings settings;
  const std::int64_t lag;         // ns
  const std::int64_t max_gap;     // ns
  const std::int64_t hold_after;  // ns
  const std::size_t generalized;  // coordinates; lengths are behind these
  std::vector<Coordinate> coordinates;
  int lead = -1;  // whose samples are the instants of motions
  std::int64_t latest_instant = std::numeric_limits<std::int64_t>::min();
  std::int64_t newest = std::numeric_limits<std::int64_t>::min();
  std::int64_t latest_gap = 0;  // ns
  int gap_coordinate = 0;
  int behind = 0;  // joint states in a row
};

MotionEstimator::Impl::Impl(const Mechanism& mechanism, const EstimatorSettings& the_settings,
                            std::size_t lengths)
    : settings(the_settings),
      lag(settings.estimate ? nanoseconds(settings.lag) : 0),
      max_gap(nanoseconds(settings.max_gap)),
      hold_after(nanoseconds(settings.hold_after)),
      generalized(mechanism.coordinates().size()) {
  coordinates.reserve(generalized + lengths);
  for (const int joint : mechanism.coordinates()) {
    coordinates.emplace_back(mechanism.joint(joint), settings);
  }
  Joint slide;
  slide.type = JointType::kPrismatic;
  for (std::size_t i = 0; i < lengths; ++i) coordinates.emplace_back(slide, settings);
}

/// Whether a stamp is so much earlier than the samples of its joints that time has gone back.
bool MotionEstimator::Impl::farBack(std::int64_t stamp, const int* indices, int count) const {
  for (int i = 0; i < count; ++i) {
    const CoordinateTrack& track = coordinates[static_cast<std::size_t>(indices[i])].track;
    if (!track.empty() && track.newest() - stamp > max_gap) return true;
  }
  return false;
}

void MotionEstimator::Impl::clear() {
  for (Coordinate& coordinate : coordinates) {
    coordinate.track.clear();
    coordinate.begun = false;
  }
  lead = -1;
  latest_instant = newest = std::numeric_limits<std::int64_t>::min();
  behind = 0;
}

/// Makes a coordinate that just came lead where none does, where the leading one has gone silent,
/// or where it comes clearly more often.
void MotionEstimator::Impl::chooseLead(int index) {
  if (index == lead || !at(index).needed) return;
  if (lead >= 0 && at(lead).needed) {
    const CoordinateTrack& leading = at(lead).track;
    const CoordinateTrack& other = at(index).track;
    const bool silent = other.newest() - leading.newest() > hold_after;
    const bool faster = other.stretch() > 2 * CoordinateTrack::kFewest &&
                        other.interval() < kFaster * leading.interval();
    if (!silent && !faster) return;
  }
  lead = index;
}

/// Whether the coordinate may be evaluated: it has been before, or has enough samples, or comes so
/// seldom that it is held, or it rests.
bool MotionEstimator::Impl::settled(const Coordinate& coordinate) const {
  const CoordinateTrack& track = coordinate.track;
  if (coordinate.rests || coordinate.begun) return true;
  if (track.empty()) return false;
  if (!settings.estimate || track.stretch() >= CoordinateTrack::kFewest) return true;
  return newest - track.stretchStart() > hold_after;
}

bool MotionEstimator::Impl::nextInstant(std::int64_t& instant) const {
  if (lead < 0) return false;
  std::int64_t after = latest_instant;
  for (const Coordinate& coordinate : coordinates) {
    if (!coordinate.needed) continue;
    if (!settled(coordinate)) return false;
    // Of a motion nothing is known before its first sample.
    if (settings.estimate && !coordinate.rests) after = std::max(after, coordinate.first - 1);
  }
  const CoordinateTrack& track = coordinates[static_cast<std::size_t>(lead)].track;
  if (settings.estimate && track.stretch() < CoordinateTrack::kFewest) return false;
  return track.nextInstant(after, lag, instant) && !inDoubt(instant);
}

/// Whether samples that are about to come will tell what a joint does at an instant.
bool MotionEstimator::Impl::inDoubt(std::int64_t instant) const {
  return std::any_of(coordinates.begin(), coordinates.end(), [&](const Coordinate& coordinate) {
    const CoordinateTrack& track = coordinate.track;
    return coordinate.needed && track.doubtStart() <= instant &&
           newest - track.newest() <= hold_after;
  });
}

Eigen::Vector3d MotionEstimator::Impl::motionOf(Coordinate& coordinate, std::int64_t instant,
                                                Eigen::Matrix3d* covariance) {
  const CoordinateTrack& track = coordinate.track;
  if (covariance != nullptr) covariance->setZero();
  coordinate.held = true;
  coordinate.begun = !track.empty();
  if (track.empty() || (coordinate.rests && instant < coordinate.first))
    return {coordinate.rest, 0, 0};
  if (!settings.estimate) {
    coordinate.held = instant - track.newest() > hold_after;
    const double qd = coordinate.held ? 0 : track.newestVelocity();
    return {track.unwrappedPosition(), std::isnan(qd) ? 0 : qd, 0};
  }
  coordinate.held = !track.covers(instant, hold_after);
  if (coordinate.held) return {track.positionBefore(instant), 0, 0};
  return track.evaluate(instant, covariance);
}

void MotionEstimator::Impl::checkSizes(const Motion& motion, const MotionCovariance* covariance,
                                       const Motion* lengths) const {
  const auto size = static_cast<Eigen::Index>(generalized);
  if (motion.q.size() != size || motion.qd.size() != size || motion.qdd.size() != size)
    throw MotionError("motion estimator: the motion has " + std::to_string(motion.q.size()) +
                      " positions, " + std::to_string(motion.qd.size()) + " velocities and " +
                      std::to_string(motion.qdd.size()) + " accelerations, must have " +
                      std::to_string(size) + " of each");
  if (covariance != nullptr && covariance->coordinates.size() != generalized)
    throw MotionError("motion estimator: the covariance has " +
                      std::to_string(covariance->coordinates.size()) + " entries, must have " +
                      std::to_string(size));
  const auto rest = static_cast<Eigen::Index>(coordinates.size()) - size;
  const Eigen::Index taken = lengths != nullptr ? lengths->q.size() : 0;
  if (taken != rest)
    throw MotionError("motion estimator: got entries for " + std::to_string(taken) +
                      " lengths, there are " + std::to_string(rest));
}

MotionEstimator::MotionEstimator(const Mechanism& mechanism, const EstimatorSettings& settings,
                                 std::size_t lengths) {
  checkSettings(settings);
  impl_ = std::make_unique<Impl>(mechanism, settings, lengths);
}

MotionEstimator::~MotionEstimator() = default;

MotionEstimator::Verdict MotionEstimator::push(std::int64_t stamp_ns, const int* coordinates,
                                               const double* q, const double* qd, int count) {
  Impl& impl = *impl_;
  Verdict verdict = Verdict::kAccepted;
  impl.latest_gap = 0;
  if (impl.farBack(stamp_ns, coordinates, count) || impl.behind >= kPatience) {
    impl.clear();
    verdict = Verdict::kRestartedBack;
  }
  int equal = 0;
  int late = 0;
  bool reordered = false;
  bool behind = count > 0;
  for (int i = 0; i < count; ++i) {
    Impl::Coordinate& coordinate = impl.at(coordinates[i]);
    CoordinateTrack& track = coordinate.track;
    if (track.empty()) coordinate.first = stamp_ns;
    const std::int64_t gap = track.empty() ? 0 : stamp_ns - track.newest();
    behind = behind && gap < 0;
    const double velocity = qd != nullptr ? qd[i] : std::numeric_limits<double>::quiet_NaN();
    switch (track.push(stamp_ns, q[i], velocity)) {
      case CoordinateTrack::Verdict::kEqualStamp:
        ++equal;
        continue;
      case CoordinateTrack::Verdict::kTooLate:
        ++late;
        continue;
      case CoordinateTrack::Verdict::kInserted:
        reordered = true;
        continue;
      case CoordinateTrack::Verdict::kAfterGap:
        if (gap > impl.latest_gap) {
          impl.latest_gap = gap;
          impl.gap_coordinate = coordinates[i];
        }
        if (verdict == Verdict::kAccepted) verdict = Verdict::kAfterGap;
        break;
      case CoordinateTrack::Verdict::kTaken:
        break;
    }
    coordinate.latest = track.unwrappedPosition();
    coordinate.seen = true;
    impl.newest = std::max(impl.newest, stamp_ns);
    impl.chooseLead(coordinates[i]);
  }
  impl.behind = behind ? impl.behind + 1 : 0;
  if (equal == count) return Verdict::kEqualStamp;
  if (equal + late == count) return Verdict::kTooLate;
  return reordered && verdict == Verdict::kAccepted ? Verdict::kReordered : verdict;
}

void MotionEstimator::waitFor(const std::vector<bool>& coordinates) {
  if (coordinates.size() != impl_->coordinates.size())
    throw MotionError("motion estimator: got " + std::to_string(coordinates.size()) +
                      " entries for the coordinates to wait for, there are " +
                      std::to_string(impl_->coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    impl_->coordinates[i].needed = coordinates[i];
  if (impl_->lead >= 0 && !impl_->at(impl_->lead).needed) impl_->lead = -1;
}

void MotionEstimator::setRest(int coordinate, double position) {
  impl_->at(coordinate).rests = true;
  impl_->at(coordinate).rest = position;
}

std::int64_t MotionEstimator::latestGap() const {
  return impl_->latest_gap;
}

int MotionEstimator::latestGapCoordinate() const {
  return impl_->gap_coordinate;
}

bool MotionEstimator::ready() const {
  std::int64_t instant = 0;
  return impl_->nextInstant(instant);
}

std::int64_t MotionEstimator::evaluate(Motion& motion, MotionCovariance* covariance,
                                       Motion* lengths) {
  std::int64_t instant = 0;
  if (!impl_->nextInstant(instant))
    throw MotionError("motion estimator: asked for a motion before it was ready");
  impl_->checkSizes(motion, covariance, lengths);
  for (std::size_t i = 0; i < impl_->coordinates.size(); ++i) {
    if (!impl_->coordinates[i].needed) continue;
    const bool is_length = i >= impl_->generalized;
    const Eigen::Vector3d state = impl_->motionOf(
        impl_->coordinates[i], instant,
        covariance != nullptr && !is_length ? &covariance->coordinates[i] : nullptr);
    const auto out = static_cast<Eigen::Index>(is_length ? i - impl_->generalized : i);
    Motion& to = is_length ? *lengths : motion;
    to.q[out] = state[0];
    to.qd[out] = state[1];
    to.qdd[out] = state[2];
  }
  impl_->latest_instant = instant;
  return instant;
}

void MotionEstimator::skip() {
  std::int64_t instant = 0;
  while (impl_->nextInstant(instant)) impl_->latest_instant = instant;
}

void MotionEstimator::reset() {
  impl_->clear();
}

bool MotionEstimator::latestPosition(int coordinate, double& q) const {
  const Impl::Coordinate& from = impl_->at(coordinate);
  if (!from.seen) return false;
  q = from.latest;
  return true;
}

bool MotionEstimator::held(int coordinate) const {
  return impl_->at(coordinate).held;
}

bool MotionEstimator::anyHeld() const {
  return std::any_of(
      impl_->coordinates.begin(), impl_->coordinates.end(),
      [](const Impl::Coordinate& coordinate) { return coordinate.held && coordinate.seen; });
}

bool MotionEstimator::knowsNoise() const {
  return std::all_of(
      impl_->coordinates.begin(), impl_->coordinates.end(), [](const Impl::Coordinate& coordinate) {
        return !coordinate.needed || !coordinate.seen || coordinate.track.knowsNoise();
      });
}

double MotionEstimator::age(int coordinate) const {
  const CoordinateTrack& track = impl_->at(coordinate).track;
  if (track.empty()) return std::numeric_limits<double>::infinity();
  return static_cast<double>(impl_->newest - track.newest()) * 1e-9;
}

StreamQuality MotionEstimator::quality(int coordinate) const {
  return impl_->at(coordinate).track.quality();
}

bool MotionEstimator::contradictory(int coordinate) const {
  return impl_->at(coordinate).track.contradictory();
}

}  // namespace virtual_work_dynamics
