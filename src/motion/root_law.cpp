#include "motion/root_law.h"

#include "motion/root_columns.h"
#include "motion/root_coordinates.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr Eigen::Index kLawCoordinates = RootCoordinates::RowsAtCompileTime;

bool givesAccelerations(const MotionTable& table) {
  return givesRoot(table, "velocity") && givesRoot(table, "angular_velocity") &&
         givesRoot(table, "acceleration") && givesRoot(table, "angular_acceleration");
}

// The coordinates as those of joints, without jumps of the quaternion's sign.
MotionTable coordinateTable(const MotionTable& table) {
  for (const char* quantity : {"position", "orientation"}) {
    if (givesRoot(table, quantity)) continue;
    throw MotionError("columns are missing: " + rootColumnsText(quantity));
  }
  MotionTable coordinates;
  coordinates.times = table.times;
  const auto rows = static_cast<Eigen::Index>(table.roots.size());
  coordinates.positions.resize(rows, kLawCoordinates);
  if (givesRoot(table, "velocity") && givesRoot(table, "angular_velocity")) {
    coordinates.velocities.resize(rows, kLawCoordinates);
  }
  if (givesAccelerations(table)) coordinates.accelerations.resize(rows, kLawCoordinates);
  RootCoordinates before;
  for (Eigen::Index row = 0; row < rows; ++row) {
    RootCoordinates now = coordinatesOf(table.roots[static_cast<std::size_t>(row)]);
    if (row > 0) chooseSign(before, now);
    coordinates.positions.row(row) = now.col(0).transpose();
    if (coordinates.hasVelocities()) coordinates.velocities.row(row) = now.col(1).transpose();
    if (coordinates.hasAccelerations()) {
      coordinates.accelerations.row(row) = now.col(2).transpose();
    }
    before = now;
  }
  for (Eigen::Index i = 0; i < kLawCoordinates; ++i) {
    coordinates.joints.push_back("root coordinate " + std::to_string(i));
  }
  return coordinates;
}

}  // namespace

RootLaw::RootLaw(const MotionTable& table)
    : has_accelerations_(givesAccelerations(table)), law_(tableLaw(coordinateTable(table))) {}

RootMotion RootLaw::at(double t) const {
  Motion motion(kLawCoordinates);
  law_->evaluate(t, motion);
  RootCoordinates coordinates;
  coordinates << motion.q, motion.qd, motion.qdd;
  return rootMotionOf(coordinates);
}

}  // namespace virtual_work_dynamics
