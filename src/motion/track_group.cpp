#include "motion/track_group.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {
namespace {

/// Samples one after the other that are behind the newest before time is taken to have gone back.
constexpr int kMostBehind = 10;

}  // namespace

TrackGroup::TrackGroup(std::size_t coordinates, const EstimatorSettings& settings)
    : max_gap_ns_(std::llround(std::min(settings.max_gap, 4e9) * 1e9)) {
  Joint coordinate;
  coordinate.type = JointType::kPrismatic;  // has no turns to be put back
  tracks_.reserve(coordinates);
  for (std::size_t i = 0; i < coordinates; ++i) tracks_.emplace_back(coordinate, settings);
}

bool TrackGroup::startsWith(std::int64_t stamp_ns) const {
  return empty() || last() - stamp_ns > max_gap_ns_ || behind_ >= kMostBehind;
}

void TrackGroup::restart() {
  for (CoordinateTrack& track : tracks_) track.clear();
  behind_ = 0;
}

TrackGroup::Verdict TrackGroup::push(std::int64_t stamp_ns, const double* values,
                                     const double* rates) {
  Verdict verdict = Verdict::kAccepted;
  if (!empty() && startsWith(stamp_ns)) {
    restart();
    verdict = Verdict::kRestartedBack;
  }
  const std::int64_t ahead = empty() ? 1 : stamp_ns - last();
  if (!empty() && ahead > 0) interval_ = static_cast<double>(ahead) / 1e9;
  behind_ = ahead < 0 ? behind_ + 1 : 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    switch (tracks_[i].push(stamp_ns, values[i], rates[i])) {
      case CoordinateTrack::Verdict::kTaken:
        break;
      case CoordinateTrack::Verdict::kInserted:
        verdict = Verdict::kReordered;
        break;
      case CoordinateTrack::Verdict::kTooLate:
        verdict = Verdict::kTooLate;
        break;
      case CoordinateTrack::Verdict::kEqualStamp:
        verdict = Verdict::kEqualStamp;
        break;
      case CoordinateTrack::Verdict::kAfterGap:
        verdict = Verdict::kAfterGap;
        break;
    }
  }
  tracks_.front().nextInstant(std::numeric_limits<std::int64_t>::min(), 0, first_);
  return verdict;
}

bool TrackGroup::knows(std::int64_t stamp_ns, std::int64_t timeout_ns) const {
  if (empty() || stamp_ns < first_) return false;
  return std::all_of(tracks_.begin(), tracks_.end(), [&](const CoordinateTrack& track) {
    return track.covers(stamp_ns, timeout_ns);
  });
}

}  // namespace virtual_work_dynamics
