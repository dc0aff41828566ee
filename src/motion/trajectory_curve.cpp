#include "motion/trajectory_curve.h"

#include <algorithm>
#include <utility>

namespace virtual_work_dynamics {

using Eigen::Index;

TrajectoryCurve::TrajectoryCurve(MotionTable points, const Eigen::VectorXd& start_velocity,
                                 const Eigen::VectorXd& end_velocity)
    : cubic_pieces_(points.hasVelocities() && !points.hasAccelerations() &&
                    points.times.size() > 1),
      spline_(std::move(points), start_velocity, end_velocity) {}

void TrajectoryCurve::evaluate(double t, Motion& motion) const {
  if (cubic_pieces_ && t >= startTime() && t <= endTime()) {
    evaluateCubic(t, motion);
  } else {
    spline_.evaluate(t, motion);
  }
}

void TrajectoryCurve::evaluateCubic(double t, Motion& motion) const {
  const MotionTable& points = spline_.knots();
  const auto time = [&points](Index row) { return points.times[static_cast<std::size_t>(row)]; };
  Index far = std::upper_bound(points.times.begin(), points.times.end(), t) - points.times.begin();
  far = std::min(far, points.positions.rows() - 1);
  Index near = far - 1;
  // The piece is expanded about the nearer point, for accuracy; from the later one the step is
  // negative.
  if (t - time(near) > time(far) - t) std::swap(near, far);
  const double tau = t - time(near);
  const double h = time(far) - time(near);
  const double s = tau / h;
  motion.q.resize(spline_.coordinates());
  motion.qd.resize(spline_.coordinates());
  motion.qdd.resize(spline_.coordinates());
  for (Index j = 0; j < spline_.coordinates(); ++j) {
    const double q = points.positions(near, j);
    const double qd = points.velocities(near, j);
    // The straight line from the near point misses the far one by these amounts.
    const double miss = points.positions(far, j) - q - h * qd;
    const double miss_d = h * (points.velocities(far, j) - qd);
    const double c2 = 3 * miss - miss_d;
    const double c3 = -2 * miss + miss_d;
    motion.q[j] = q + tau * qd + s * s * (c2 + s * c3);
    motion.qd[j] = qd + s * (2 * c2 + 3 * s * c3) / h;
    motion.qdd[j] = (2 * c2 + 6 * s * c3) / (h * h);
  }
}

}  // namespace virtual_work_dynamics
