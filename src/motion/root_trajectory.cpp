#include "motion/root_trajectory.h"

#include <algorithm>

#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {

constexpr std::size_t RootTrajectory::kMost;

void RootTrajectory::take(const std::vector<RootPoint>& points) {
  const std::int64_t start = points.front().stamp_ns;
  while (!pieces_.empty() && pieces_.back().from.stamp_ns >= start) pieces_.pop_back();
  for (const RootPoint& point : points) {
    Knot knot{point.stamp_ns, coordinatesOf(point.motion)};
    if (!pieces_.empty()) {
      Piece& before = pieces_.back();
      chooseSign(before.from.motion, knot.motion);
      const bool joined =
          point.stamp_ns != start || point.stamp_ns - before.from.stamp_ns <= timeout_ns_;
      if (before.open && joined) {
        before.to = knot;
        before.open = false;
      }
    }
    pieces_.push_back({knot, knot, true});
  }
  const std::size_t most = std::max(kMost, points.size());
  while (pieces_.size() > most) pieces_.pop_front();
}

bool RootTrajectory::read(std::int64_t stamp_ns, RootMotion& motion, RootCovariance* covariance) {
  if (covariance) covariance->setZero();
  const auto later = std::upper_bound(
      pieces_.begin(), pieces_.end(), stamp_ns,
      [](std::int64_t stamp, const Piece& piece) { return stamp < piece.from.stamp_ns; });
  if (later == pieces_.begin()) return false;
  const Piece& piece = *(later - 1);
  if (piece.open && stamp_ns - piece.from.stamp_ns > timeout_ns_) return false;
  foreseen_ = piece.open && stamp_ns > piece.from.stamp_ns;
  motion = rootMotionOf(between(piece, stamp_ns));
  return true;
}

// The quintic x0 + h v0 s + h^2 a0 s^2 / 2 + c3 s^3 + c4 s^4 + c5 s^5 in s from 0 to 1, or what it
// begins with.
RootCoordinates RootTrajectory::between(const Piece& piece, std::int64_t stamp_ns) {
  const RootCoordinates& start = piece.from.motion;
  const double t = secondsBetween(piece.from.stamp_ns, stamp_ns);
  RootCoordinates motion;
  motion.col(0) = start.col(0) + t * (start.col(1) + t / 2 * start.col(2));
  motion.col(1) = start.col(1) + t * start.col(2);
  motion.col(2) = start.col(2);
  if (piece.open) return motion;

  using Vector7d = Eigen::Matrix<double, 7, 1>;
  const RootCoordinates& end = piece.to.motion;
  const double h = secondsBetween(piece.from.stamp_ns, piece.to.stamp_ns);
  const double s = t / h;
  // By how much the end is missed with constant accelerations, scaled to s.
  const Vector7d d0 = end.col(0) - start.col(0) - h * (start.col(1) + h / 2 * start.col(2));
  const Vector7d d1 = h * (end.col(1) - start.col(1) - h * start.col(2));
  const Vector7d d2 = h * h * (end.col(2) - start.col(2));
  const Vector7d c3 = 10 * d0 - 4 * d1 + d2 / 2;
  const Vector7d c4 = -15 * d0 + 7 * d1 - d2;
  const Vector7d c5 = 6 * d0 - 3 * d1 + d2 / 2;
  motion.col(0) += s * s * s * (c3 + s * (c4 + s * c5));
  motion.col(1) += s * s / h * (3 * c3 + s * (4 * c4 + s * 5 * c5));
  motion.col(2) += s / (h * h) * (6 * c3 + s * (12 * c4 + s * 20 * c5));
  return motion;
}

}  // namespace virtual_work_dynamics
