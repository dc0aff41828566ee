#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "motion/root_coordinates.h"
#include "motion/root_course.h"

namespace virtual_work_dynamics {

/// An instant of a trajectory of the root link.
struct RootPoint {
  std::int64_t stamp_ns = 0;
  RootMotion motion;
};

/// The motion of a root link that trajectories give by points with velocities and accelerations.
/// From point to point the seven RootCoordinates go by quintics, which at the points have position,
/// orientation, velocities and accelerations exactly. From one point to the next the root turns by
/// less than half a turn.
class RootTrajectory : public RootCourse {
 public:
  /// Points that are kept, at least.
  static constexpr std::size_t kMost = 16384;

  /// @param timeout_ns longest time behind the last point in which the motion goes on with its
  ///   accelerations, and longest one between two trajectories that are joined by a quintic
  explicit RootTrajectory(std::int64_t timeout_ns) : timeout_ns_(timeout_ns) {}

  /// Takes a trajectory. It replaces what was known from its first point on. Allocates.
  /// @param points at least one, stamps increasing
  void take(const std::vector<RootPoint>& points);

  using RootCourse::read;
  bool read(std::int64_t stamp_ns, RootMotion& motion, RootCovariance* covariance) override;
  bool foreseen() const override { return foreseen_; }
  bool empty() const override { return pieces_.empty(); }
  std::int64_t first() const override { return pieces_.front().from.stamp_ns; }
  std::int64_t last() const override { return pieces_.back().from.stamp_ns; }

 private:
  struct Knot {
    std::int64_t stamp_ns;
    RootCoordinates motion;
  };
  // It holds until the next piece begins, which may be before its end.
  struct Piece {
    Knot from, to;
    bool open;  // there is nothing to go to
  };

  static RootCoordinates between(const Piece& piece, std::int64_t stamp_ns);

  const std::int64_t timeout_ns_;
  std::deque<Piece> pieces_;
  bool foreseen_ = false;
};

}  // namespace virtual_work_dynamics
