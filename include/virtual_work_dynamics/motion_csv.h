#pragma once

#include <cstddef>
#include <functional>
#include <istream>
#include <string>
#include <vector>

#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Reads a motion from CSV. Its header has
/// `time,position.<joint>…,velocity.<joint>…,acceleration.<joint>…` in any order, lines that start with `#` are comments. Velocities and accelerations are optional,
/// each for all joints or for none. Blanks around names and cells, CRLF and a UTF-8 byte order mark
/// are no part of the text.
/// @param joints which joints, in which order; empty: every joint that has a position column, in
/// the
///   order of the header (a file of nothing but times is then a table without joints). Columns of
///   other joints are ignored and listed in `unused` when not null.
/// @param lines when not null: the line, counted from 1, of each row of the table.
/// @throws FileError naming file, line and column: unreadable or empty file, header only, missing
/// or
///   doubled column, a column that is none of the kinds above, ragged row, something that is no
///   finite number.
MotionTable readMotionCsv(const std::string& path, const std::vector<std::string>& joints = {},
                          std::vector<std::string>* unused = nullptr,
                          std::vector<std::size_t>* lines = nullptr);

/// Of the joints that have a position column, in the order of the header, those to be read.
using JointChoice =
    std::function<std::vector<std::string>(const std::vector<std::string>& with_positions)>;

/// The same for joints that depend on the header; none are none. What `choose` throws passes.
MotionTable readMotionCsv(const std::string& path, const JointChoice& choose,
                          std::vector<std::string>* unused = nullptr,
                          std::vector<std::size_t>* lines = nullptr);

/// The same as the first from a stream; `name` stands for the file in messages.
MotionTable readMotionCsv(std::istream& stream, const std::string& name,
                          const std::vector<std::string>& joints = {},
                          std::vector<std::string>* unused = nullptr,
                          std::vector<std::size_t>* lines = nullptr);

}  // namespace virtual_work_dynamics
