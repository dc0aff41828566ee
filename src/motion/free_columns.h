#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// How the columns that give a joint that turns freely are called, for messages.
constexpr char kFreeColumns[] =
    "orientation.<joint>.{x,y,z,w}, angular_velocity.<joint>.{x,y,z}, "
    "angular_acceleration.<joint>.{x,y,z}";

/// Whether a column is one of these.
bool isFreeColumn(std::string_view column);
/// The joints of a header that have such columns, in its order.
std::vector<std::string> freeJointsOf(const std::vector<std::string>& header);
/// The columns to read of a joint: all of each quantity that the header has any of, in the order
/// that takeFreeTurns() expects.
std::vector<std::string> freeColumnsOf(const std::vector<std::string>& header,
                                       const std::string& joint);
/// How the columns of a quantity of a joint are called: "orientation.ball.{x,y,z,w}".
std::string freeColumnsText(const std::string& quantity, const std::string& joint);

/// Adds the motion of a joint to `table`, orientations scaled to unit length.
/// @param columns freeColumnsOf() the joint
/// @returns the first row whose orientation is off unit length by more than 1e-3; else the number
/// of
///   rows
std::size_t takeFreeTurns(const std::string& joint, const std::vector<std::string>& columns,
                          const Eigen::MatrixXd& values, MotionTable& table);

/// The names of the motion of all coordinates, as columns: positions, velocities and accelerations
/// of those that are not angles of joints that turn freely, then the columns above of these joints.
std::vector<std::string> motionColumns(const Mechanism& mechanism);
/// Appends the numbers of a motion in these columns.
void appendMotion(const Mechanism& mechanism, const Motion& motion, std::vector<double>& numbers);

}  // namespace virtual_work_dynamics
