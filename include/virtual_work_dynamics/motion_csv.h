#pragma once

#include <cstddef>
#include <functional>
#include <istream>
#include <string>
#include <vector>

#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Reads a motion from CSV. Its header has, in any order, the columns
/// `time,position.<joint>…,velocity.<joint>…,acceleration.<joint>…`;
/// lines that start with `#` are comments. Velocities and accelerations are optional,
/// each for all joints or for none. Columns `wrench.<name>.fx` to `.tz`, all six, give a wrench.
/// Blanks around names and cells, CRLF, a UTF-8 byte order mark and a comma at the end of every
/// line are ignored; names and cells may stand in quotes (RFC 4180). An unnamed first column is
/// taken for numbers of rows, and what results hold
/// (`effort.<joint>` and the like) for other columns.
/// @param joints the joints to read, in the order of the table's columns. When empty, every joint
///   that has a position column is read, in the order of the header; a file of times alone is then
///   a table without joints. Columns of other joints are ignored.
/// @param unused receives the names of the ignored columns when not null.
/// @param lines receives the line, counted from 1, of each row of the table when not null.
/// @throws FileError naming file, line and column: unreadable or empty file, header only, missing
///   or doubled column, column of another kind, ragged row, cell that is not a finite number.
MotionTable readMotionCsv(const std::string& path, const std::vector<std::string>& joints = {},
                          std::vector<std::string>* unused = nullptr,
                          std::vector<std::size_t>* lines = nullptr);

/// Chooses the joints to read from those that have a position column, which come in the order of
/// the header.
using JointChoice =
    std::function<std::vector<std::string>(const std::vector<std::string>& with_positions)>;

/// Reads a motion from CSV with the joints chosen once the header is known; an empty choice reads
/// no joint. Exceptions of `choose` propagate.
MotionTable readMotionCsv(const std::string& path, const JointChoice& choose,
                          std::vector<std::string>* unused = nullptr,
                          std::vector<std::size_t>* lines = nullptr);

/// Reads a motion from a stream of CSV text; `name` stands for the file in messages.
MotionTable readMotionCsv(std::istream& stream, const std::string& name,
                          const std::vector<std::string>& joints = {},
                          std::vector<std::string>* unused = nullptr,
                          std::vector<std::size_t>* lines = nullptr);

}  // namespace virtual_work_dynamics
