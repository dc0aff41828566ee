#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "motion/coordinate_track.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// Coordinates that are always sampled together, each with a CoordinateTrack: takes their samples
/// as they come, and gives them and their derivatives at any instant that samples surround, or that
/// is a little later. Does not allocate after construction.
class TrackGroup {
 public:
  /// @param settings with the noises of the coordinates
  TrackGroup(std::size_t coordinates, const EstimatorSettings& settings);

  /// What push() did with a sample.
  enum class Verdict {
    kAccepted,
    kReordered,     ///< accepted: it came late, and took its place among the others
    kTooLate,       ///< dropped: it came late, and its place is no longer kept
    kEqualStamp,    ///< dropped: there is a sample of this stamp
    kAfterGap,      ///< accepted, after a gap longer than max_gap
    kRestartedBack  ///< accepted as the first one, as time went far back
  };
  /// @param values,rates one of each coordinate; a rate that is NaN is not given
  Verdict push(std::int64_t stamp_ns, const double* values, const double* rates);
  /// Forgets all samples: the next one is taken as the first.
  void restart();
  /// Whether a sample of this stamp would be taken as the first one.
  bool startsWith(std::int64_t stamp_ns) const;

  /// Whether the coordinates can be estimated at an instant: at most `timeout_ns` behind the newest
  /// sample, not before the first one that is kept, and not in a gap.
  bool knows(std::int64_t stamp_ns, std::int64_t timeout_ns) const;
  /// The coordinate with its first and second derivative, and their covariance unless null; to be
  /// called where it is known.
  Eigen::Vector3d evaluate(std::size_t coordinate, std::int64_t stamp_ns,
                           Eigen::Matrix3d* covariance = nullptr) const {
    return tracks_[coordinate].evaluate(stamp_ns, covariance);
  }

  /// The coordinate in the latest sample up to an instant; to be called unless empty().
  double before(std::size_t coordinate, std::int64_t stamp_ns) const {
    return tracks_[coordinate].positionBefore(stamp_ns);
  }

  bool empty() const { return tracks_.front().empty(); }
  /// First and last stamp of the samples that are kept, ns; to be called unless empty().
  std::int64_t first() const { return first_; }
  std::int64_t last() const { return tracks_.front().newest(); }
  /// The latest time from one sample to the next, s; infinite before there are two.
  double interval() const { return interval_; }
  StreamQuality quality(std::size_t coordinate) const { return tracks_[coordinate].quality(); }

 private:
  const std::int64_t max_gap_ns_;
  std::vector<CoordinateTrack> tracks_;
  std::int64_t first_ = 0;
  double interval_ = std::numeric_limits<double>::infinity();
  int behind_ = 0;  // samples in a row that are behind the newest
};

}  // namespace virtual_work_dynamics
