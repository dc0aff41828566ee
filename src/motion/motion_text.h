#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "virtual_work_dynamics/motion_csv.h"

namespace virtual_work_dynamics {

/// Reads a motion as readMotionCsv() does, line by line as the text comes. A line that seems to
/// have no end is refused. @param name stands for the text in messages.
/// @param rename for the joints in the names of columns; empty: they stay
MotionTable readMotionText(TextSource& text, const std::string& name,
                           const std::function<std::string(const std::string&)>& rename,
                           const JointChoice& choose, std::vector<std::string>* unused,
                           std::vector<std::size_t>* lines);

}  // namespace virtual_work_dynamics
