#include "motion/free_turn_completion.h"

#include <algorithm>
#include <utility>

#include "motion/root_coordinates.h"

namespace virtual_work_dynamics {

std::vector<RootEstimate> estimateFreeTurns(const Mechanism& mechanism, const MotionTable& motion,
                                            const CompletionSettings& settings, FreeTurns& turns) {
  if (turns.lack.empty()) return {};
  // A root link that turns as the child link does, in axes of the parent.
  MotionTable roots;
  roots.times = motion.times;
  roots.roots.resize(turns.rows.size());
  roots.roots_lack = turns.lack;
  for (std::size_t row = 0; row < turns.rows.size(); ++row) {
    const FreeTurn& turn = turns.rows[row];
    RootMotion& root = roots.roots[row];
    root.orientation = turn.orientation;
    root.angular_velocity = turn.orientation * turn.angular_velocity;
    root.angular_acceleration = turn.orientation * turn.angular_acceleration;
  }
  std::vector<RootEstimate> estimates = completeRoots(mechanism, roots, settings);
  for (RootEstimate& estimate : estimates) {
    for (std::size_t i = 0; i < estimate.names.size(); ++i) {
      estimate.names[i] = "orientation." + turns.joint + " (" + std::to_string(i + 1) + ")";
    }
  }
  for (std::size_t row = 0; row < turns.rows.size(); ++row) {
    const RootMotion& root = roots.roots[row];
    const Eigen::Quaterniond back = root.orientation.conjugate();
    turns.rows[row] = {root.orientation, back * root.angular_velocity,
                       back * root.angular_acceleration};
    if (roots.root_covariances.empty()) continue;
    turns.covariances.push_back(
        inBodyAxes(turns.rows[row], roots.root_covariances[row].topLeftCorner<9, 9>()));
  }
  turns.lack.clear();
  return estimates;
}

void placeFreeTurns(const Mechanism& mechanism, MotionTable& motion) {
  const auto rows = static_cast<Eigen::Index>(motion.times.size());
  const auto coordinates = static_cast<Eigen::Index>(mechanism.coordinates().size());
  motion.orientations.setZero(rows, static_cast<Eigen::Index>(4 * mechanism.orientations()));
  Motion row_motion(coordinates, mechanism.orientations());
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    const auto first = static_cast<Eigen::Index>(4 * i);
    motion.orientations.col(first + 3).setOnes();
    const std::string& name = mechanism.freeJoint(i).name;
    const auto turns = std::find_if(motion.turns.begin(), motion.turns.end(),
                                    [&](const FreeTurns& own) { return own.joint == name; });
    if (turns == motion.turns.end()) continue;
    const Eigen::Index angle = mechanism.anglesOf(i);
    for (Eigen::Index row = 0; row < rows; ++row) {
      setFreeTurn(mechanism, i, turns->rows[static_cast<std::size_t>(row)], row_motion);
      motion.positions.row(row).segment<3>(angle) = row_motion.q.segment<3>(angle);
      motion.velocities.row(row).segment<3>(angle) = row_motion.qd.segment<3>(angle);
      motion.accelerations.row(row).segment<3>(angle) = row_motion.qdd.segment<3>(angle);
      motion.orientations.row(row).segment<4>(first) = row_motion.orientations[i].coeffs();
    }
  }
}

}  // namespace virtual_work_dynamics
