#include "motion/root_completion.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "motion/root_coordinates.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

bool lacks(const MotionTable& motion, const char* quantity) {
  return std::count(motion.roots_lack.begin(), motion.roots_lack.end(), quantity) > 0;
}

// The coordinates of each row, whose quaternions are continued.
std::vector<RootCoordinates> coordinatesOfRows(const MotionTable& motion) {
  std::vector<RootCoordinates> rows;
  rows.reserve(motion.roots.size());
  for (const RootMotion& root : motion.roots) {
    rows.push_back(coordinatesOf(root));
    if (rows.size() > 1) chooseSign(rows[rows.size() - 2], rows.back());
  }
  return rows;
}

// The coordinates of a position, or of an orientation.
struct Group {
  Eigen::Index first, count;
  Names names;
  bool with_velocities;
};

// `each` receives the covariances by row unless it is empty.
CompletionReport estimate(const Mechanism& mechanism, const CompletionSettings& settings,
                          const std::vector<double>& times, const Group& group,
                          std::vector<RootCoordinates>& rows,
                          std::vector<RootCoordinateCovariances>& each) {
  MotionTable table;
  table.times = times;
  table.joints = group.names;
  table.positions.resize(static_cast<Eigen::Index>(rows.size()), group.count);
  if (group.with_velocities) table.velocities.resizeLike(table.positions);
  for (Eigen::Index row = 0; row < table.positions.rows(); ++row) {
    const auto from = rows[static_cast<std::size_t>(row)].middleRows(group.first, group.count);
    table.positions.row(row) = from.col(0).transpose();
    if (group.with_velocities) table.velocities.row(row) = from.col(1).transpose();
  }
  CompletionReport report;
  table = completeMotion(mechanism, std::move(table), settings, &report);
  for (Eigen::Index row = 0; row < table.positions.rows(); ++row) {
    auto to = rows[static_cast<std::size_t>(row)].middleRows(group.first, group.count);
    to.col(0) = table.positions.row(row).transpose();
    to.col(1) = table.velocities.row(row).transpose();
    to.col(2) = table.accelerations.row(row).transpose();
  }
  const auto count = static_cast<std::size_t>(group.count);
  for (std::size_t row = 0; row < each.size(); ++row) {
    std::copy_n(table.covariances.begin() + static_cast<std::ptrdiff_t>(row * count), count,
                each[row].begin() + group.first);
  }
  return report;
}

// Of orientations and angular accelerations that are given, nothing is estimated.
void makeExact(RootCovariance& covariance) {
  for (const Eigen::Index first : {0, 6}) {
    covariance.middleRows<3>(first).setZero();
    covariance.middleCols<3>(first).setZero();
  }
}

}  // namespace

std::vector<RootEstimate> completeRoots(const Mechanism& mechanism, MotionTable& motion,
                                        const CompletionSettings& settings) {
  const bool linear = lacks(motion, "acceleration");
  const bool angular = lacks(motion, "angular_acceleration");
  const bool rates = lacks(motion, "angular_velocity");
  if (linear && lacks(motion, "position"))
    throw MotionError("motion: the root's accelerations are not given, nor are its positions");
  CompletionSettings own;
  own.lag = settings.lag;
  own.max_gap = settings.max_gap;
  own.covariances = settings.covariances;
  own.noise.use_velocity = settings.noise.use_velocity;
  own.noise.stamp_noise = 0;  // see RootEstimator
  own.other_columns = true;
  std::vector<Group> groups;
  if (linear) {
    groups.push_back({0,
                      3,
                      {"root.position.x", "root.position.y", "root.position.z"},
                      !lacks(motion, "velocity")});
  }
  if (angular || rates) {
    groups.push_back({3,
                      4,
                      {"root.orientation (1)", "root.orientation (2)", "root.orientation (3)",
                       "root.orientation (4)"},
                      !rates});
  }
  std::vector<RootEstimate> estimates;
  std::vector<RootCoordinates> rows = coordinatesOfRows(motion);
  RootCoordinateCovariances nothing;
  nothing.fill(Eigen::Matrix3d::Zero());
  std::vector<RootCoordinateCovariances> each(settings.covariances ? rows.size() : 0, nothing);
  for (const Group& group : groups)
    estimates.push_back({group.names, estimate(mechanism, own, motion.times, group, rows, each)});
  motion.root_covariances.clear();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    RootMotion& root = motion.roots[row];
    const RootMotion found = rootMotionOf(rows[row]);
    if (linear) {
      root.position = found.position;
      root.velocity = found.velocity;
      root.acceleration = found.acceleration;
    }
    if (rates || angular) root.angular_velocity = found.angular_velocity;
    if (angular) {
      root.orientation = found.orientation;
      root.angular_acceleration = found.angular_acceleration;
    }
    if (each.empty()) continue;
    motion.root_covariances.push_back(rootCovarianceOf(found, each[row]));
    if (!angular) makeExact(motion.root_covariances.back());
  }
  motion.roots_lack.clear();
  return estimates;
}

}  // namespace virtual_work_dynamics
