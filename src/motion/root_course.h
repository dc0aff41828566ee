#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/noise_settings.h"
#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// Measured numbers that a root's motion is estimated from, and what they were found to be.
struct RootStream {
  const char* name;
  const char* unit;
  const char* noise;  ///< whose deviation StreamQuality::position_noise is
  StreamQuality quality;
};

/// How a root link moves, as it becomes known piece by piece.
class RootCourse {
 public:
  virtual ~RootCourse() = default;

  /// Finds the motion at an instant, ns. Returns false, and changes nothing, where it is not known.
  /// Does not allocate.
  /// @param covariance of the motion, unless null
  virtual bool read(std::int64_t stamp_ns, RootMotion& motion, RootCovariance* covariance) = 0;
  bool read(std::int64_t stamp_ns, RootMotion& motion) { return read(stamp_ns, motion, nullptr); }
  /// Index of the link whose motion is read: the root link, unless a sensor on another link tells
  /// how it moves, from which that of the root then follows.
  virtual int link() const { return 0; }
  /// Whether the motion that was read last lies behind all that is known, and was foreseen.
  virtual bool foreseen() const = 0;

  /// Whether anything has come.
  virtual bool empty() const = 0;
  /// First and last stamp of what is kept, ns; to be called unless empty().
  virtual std::int64_t first() const = 0;
  virtual std::int64_t last() const = 0;
  /// Where accelerations are estimated: the latest time from one sample to the next, s; infinite
  /// before there are two. Zero where they are given.
  virtual double interval() const { return 0; }
  /// Most streams of a course.
  static constexpr std::size_t kMostStreams = 7;
  /// Lists the streams that the motion is estimated from; none where it is given. Does not allocate
  /// where `streams` has room for kMostStreams.
  virtual void getStreams(std::vector<RootStream>& streams) const { streams.clear(); }
};

}  // namespace virtual_work_dynamics
