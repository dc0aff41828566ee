#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// How columns of the motion of the root link are named, as messages say it.
constexpr char kRootColumns[] =
    "root.{position,velocity,angular_velocity,acceleration,angular_acceleration}.{x,y,z}, "
    "root.orientation.{x,y,z,w}";

/// Whether a column is a number of the motion of the root link.
bool isRootColumn(std::string_view column);

/// All columns of the quantities of which `header` has any, in the order of RootMotion.
std::vector<std::string> rootColumnsOf(const std::vector<std::string>& header);

/// The columns of a quantity, as a message names them together: "root.acceleration.{x,y,z}".
std::string rootColumnsText(const std::string& quantity);

/// Whether a table has a quantity of the motion of the root link, such as "position".
bool givesRoot(const MotionTable& table, const std::string& quantity);

/// Fills MotionTable::roots and what belongs to it. Orientations become of unit length.
/// @param columns as rootColumnsOf() gives them
/// @param values rows x columns
/// @returns the first row whose orientation is more than 1e-3 longer or shorter than 1; the number
/// of
///   rows when there is none
std::size_t takeRoots(const std::vector<std::string>& columns, const Eigen::MatrixXd& values,
                      MotionTable& table);

}  // namespace virtual_work_dynamics
