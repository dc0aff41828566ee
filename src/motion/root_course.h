#pragma once

#include <cstdint>

#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// How a root link moves, as it becomes known piece by piece.
class RootCourse {
 public:
  virtual ~RootCourse() = default;

  /// Finds the motion at an instant, ns. Returns false, and changes nothing, where it is not known.
  /// Does not allocate.
  virtual bool read(std::int64_t stamp_ns, RootMotion& motion) = 0;
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
};

}  // namespace virtual_work_dynamics
